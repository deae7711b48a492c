"""pyNastran's objects where a file is taken, and given back; its values are ours."""

import json
import os
from pathlib import Path

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck, read_modes
from trueup.adapters.nastran.deck.pynastran_bridge import file_of
from trueup.core.errors import InputError

DUCT = Path(__file__).parents[4] / "fixtures" / "duct" / "duct.bdf"

# Attributes of pyNastran's cards beside ours, where both mean the same.
SAME = {
    "GRID": [("cp", "cp"), ("xyz", "xyz"), ("cd", "cd")],
    **{
        name: [("pid", "pid"), ("nodes", "nodes"), ("theta_mcid", "theta"), ("zoffset", "zoffs")]
        for name in ("CQUAD4", "CTRIA3", "CQUADR", "CTRIAR")
    },
    **{name: [("pid", "pid")] for name in ("CTETRA", "CPENTA", "CHEXA")},
    **{name: [("pid", "pid"), ("nodes", "nodes")] for name in ("CROD", "CTUBE", "CVISC")},
    "CBAR": [("pid", "pid"), ("nodes", "nodes"), ("wa", "wa"), ("wb", "wb")],
    "CBEAM": [("pid", "pid"), ("nodes", "nodes"), ("wa", "wa"), ("wb", "wb")],
    "CELAS2": [("k", "k"), ("c1", "components[0]")],
    "CONM2": [("nid", "g"), ("mass", "m"), ("X", "x"), ("I", "i")],
    "CONROD": [("mid", "mid"), ("A", "a"), ("j", "j"), ("nsm", "nsm")],
    "PSHELL": [("mid1", "mid1"), ("t", "t"), ("twelveIt3", "bending"), ("tst", "shear")],
    "PBAR": [("A", "a"), ("i1", "i1"), ("i2", "i2"), ("i12", "i12"), ("j", "j"), ("nsm", "nsm")],
    "PBARL": [("dim", "dim"), ("nsm", "nsm")],
    "PBEAM": [
        ("xxb", "x"), ("A", "a"), ("i1", "i1"), ("i2", "i2"), ("i12", "i12"), ("j", "j"),
        ("nsm", "nsm"), ("k1", "k1"), ("k2", "k2"), ("n1a", "n[0]"), ("n2b", "n[3]"),
    ],
    "PROD": [("A", "a"), ("j", "j"), ("nsm", "nsm")],
    "PCOMP": [("thicknesses", "t"), ("thetas", "theta"), ("mids", "mid"), ("nsm", "nsm")],
    "PELAS": [("k", "k"), ("ge", "ge")],
    "MAT1": [("rho", "rho"), ("a", "a"), ("ge", "ge")],
    "MAT8": [("e11", "e1"), ("e22", "e2"), ("nu12", "nu12"), ("g12", "g12"), ("rho", "rho")],
    "RBE2": [("gn", "gn"), ("cm", "cm"), ("Gmi", "gm")],
    "RBE3": [
        ("refgrid", "refgrid"), ("refc", "refc"), ("weights", "weights"), ("comps", "components"),
        ("Gijs", "groups"),
    ],
}  # fmt: skip
TABLES = ("nodes", "elements", "masses", "properties", "materials", "rigid_elements")


def value(card, attribute):
    name, _, index = attribute.partition("[")
    found = getattr(card, name)
    return found[int(index[:-1])] if index else found


def plain(found):
    return json.loads(json.dumps(found, default=lambda v: np.asarray(v).tolist()))


def shared():
    return Path(os.environ.get("TRUEUP_DATA", Path(__file__).parents[5] / "shared" / "data"))


def decks():
    root = shared()
    return [DUCT, *sorted(root.glob("nastran/*/*.bdf")), *sorted(root.glob("nastran/*/*.dat"))]


def read_by_pynastran(path):
    bdf = pytest.importorskip("pyNastran.bdf.bdf")
    model = bdf.BDF(debug=None)
    try:
        model.read_bdf(str(path), xref=False)
    except Exception as error:  # noqa: BLE001 - what it cannot read it cannot tell of
        pytest.skip(f"pyNastran does not read it: {str(error)[:60]}")
    return model


@pytest.mark.parametrize("path", decks(), ids=lambda p: f"{p.parent.name}/{p.name}")
def test_every_value_is_the_one_pynastran_reads(path):
    theirs = read_by_pynastran(path)
    try:
        ours = read_deck(path).bulk
    except InputError as error:
        pytest.skip(str(error)[:80])
    for name, attributes in SAME.items():
        for number, card in ours.table(name).items():
            other = next(t[number] for t in (getattr(theirs, n) for n in TABLES)
                         if number in t and t[number].type.startswith(name[:5]))  # fmt: skip
            for their, our in attributes:
                assert plain(value(other, their)) == plain(value(card, our)), (name, number, our)


def test_a_deck_goes_to_pynastran_and_back():
    pytest.importorskip("pyNastran")
    deck = read_deck(DUCT)
    bdf = deck.to_pynastran()
    assert len(bdf.nodes) == deck.counts["GRID"]
    again = read_deck(bdf)
    assert (deck.told, again.told) == (str(DUCT), "duct.bdf (an object, not the file)")
    there, back = build_model(deck), build_model(again)
    for a, b in zip(there.stiffness + there.mass, back.stiffness + back.mass, strict=True):
        assert abs(a.matrix - b.matrix).max() <= 1e-9 * abs(a.matrix).max()


def test_modes_of_an_op2_object_are_those_of_its_file_and_its_own():
    op2 = pytest.importorskip("pyNastran.op2.op2").OP2(debug=None)
    path = shared() / "nastran" / "plate" / "plate_py.op2"
    if not path.is_file():
        pytest.skip("no shared data beside the repository")
    op2.read_op2(str(path))
    found, ours, theirs = read_modes(op2), read_modes(path), op2.eigenvectors[1]
    np.testing.assert_array_equal(found.shapes, ours.shapes)
    np.testing.assert_array_equal(found.frequencies_hz, ours.frequencies_hz)
    np.testing.assert_array_equal(found.shapes.T.reshape(theirs.data.shape), theirs.data)
    np.testing.assert_array_equal(found.dofs.node[::6], theirs.node_gridtype[:, 0])


def test_other_objects_are_refused():
    with pytest.raises(InputError, match="path or an object of pyNastran"):
        file_of({"nodes": {}})


def test_a_deck_is_one_line():
    assert repr(read_deck(DUCT)).startswith("Deck('duct.bdf': 1,933 grids, ")

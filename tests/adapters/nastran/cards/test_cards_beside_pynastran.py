"""Every card of the registry, drawn from its definition, read as pyNastran reads it.

Values come from the kinds and defaults of a definition, blanks where it has a default; the card
is printed in small, large or free fields, and every value that both name is compared.
"""

import re
from itertools import zip_longest

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings, strategies as st

from trueup.adapters.nastran import read_deck
from trueup.adapters.nastran.cards import definitions
from trueup.adapters.nastran.deck.field_values import MISSING
from trueup.adapters.nastran.deck.raw_cards import fields_of

bdf = pytest.importorskip("pyNastran.bdf.bdf", reason="the peer is not installed")

APART_AS_A_WHOLE = (
    "BND",
    "GENEL",
    "CWELD",
    "PWELD",
    "PCOMPS",
    "PBCOMP",
    "PBEND",
    "CBEAM3",
    "PBEAM3",
    "SE",
    "POINT",
    "EXTRN",
    "CTRIAX6",
    "MAT3",
    "RJOINT",
    "RTRPLT",
    "RSPLINE",
)
READ = {
    n: c
    for n, c in definitions().items()
    # pyNastran does not know BNDFIX, CWELD and their like; the others have tests of their own
    if not (c.ignored or c.refused or n.startswith(APART_AS_A_WHOLE))
}
REAL = st.builds(
    "{}{}{}".format,
    st.sampled_from(["", "-"]),
    st.integers(1, 799).map(lambda n: f"{n / 8}"[:5]),
    st.sampled_from(["", "", "+2", "-3", "E1", "D1"]),
)
POSITIVE = REAL.map(lambda text: text.lstrip("-"))
COMPONENTS = st.sets(st.sampled_from("123456"), min_size=1).map(lambda c: "".join(sorted(c)))
KINDS = {"r": REAL, "c": COMPONENTS}


def words(text):
    return st.sampled_from(text.split())


def reals(count):
    return st.lists(POSITIVE, min_size=count, max_size=count)


def points(blank):
    """The pairs of a table behind the blank rest of its first line, ENDT."""
    pairs = st.lists(POSITIVE, min_size=2, max_size=5).map(lambda y: [
        text for k, value in enumerate(y) for text in (f"{k}.5", value)
    ])  # fmt: skip
    return pairs.map(lambda found: [*[None] * blank, *found, "ENDT"])


GRIDS = st.sets(st.integers(1, 999), min_size=1, max_size=9).map(
    lambda found: [str(n) for n in sorted(found)]
)
LIST = GRIDS | st.integers(1, 900).map(lambda n: [str(n), "THRU", str(n + 7)])
DOFS = st.lists(COMPONENTS, min_size=1, max_size=3).map(
    lambda found: [text for k, c in enumerate(found, 41) for text in (str(k), c)]
)
SECTION = reals(6).map(lambda v: [v[0], "9.E6", "8.E6", *v[3:]])

# What the kind of a field does not tell: by CARD.NAME, NAME, NAME:kind or attribute:kind.
WORDS = """
LAM SYM|FT HILL HOFF TSAI STRN|SOUT YES NO|GROUP MSCBML0|OFFT GGG GGO OGG OGO|FCTN SMECH
EXTRAP 0 1|XAXIS LINEAR LOG|YAXIS LINEAR LOG|IN BUBBLE TWO THREE|STRESS GRID GAUSS
ISOP REDUCED FULL|TFLAG 0 1|NORM MASS MAX|METHOD LAN AHOU|MSGLVL 0 1 2 3 4|PARAM.N WTMASS K6ROT
PARAM.V1 0.5 227.25|X3:r -2. 1.5|X4:r 2. 1.5E2|NSM.TYPE PSHELL PBAR PBEAM|NSML.TYPE PSHELL PROD
NSM1.TYPE PSHELL|NSML1.TYPE ELEMENT|PBARL.TYPE BAR TUBE2|PBEAML.TYPE BAR|components:i 1 2 3
RBAR.CNA 123456|RROD.CMA 1 2 3|DMIG.NAME MADE|DMIG.CJ 1 2 3|DTI.NAME UNITS|DTI.IREC 1|DTI.MASS KG
DTI.FORCE N|CFAST.TYPE PROP ELEM|GEOM 1 2 3 4|MFLAG 0 1|DTI.LENGTH M MM|DTI.TIME S
TABDMP1.TYPE G CRIT Q"""
BLANK = "EIGR.G EIGR.C PARAM.V2 RBAR.CNB RBAR.CMA RROD.CMB PBAR.I12 RBAR1.TREF RROD.TREF DMIG.B"
DRAWN = {
    **{w.split()[0]: words(w.partition(" ")[2]) for w in re.split(r"[|\n]", WORDS.strip())},
    **dict.fromkeys(("T", "OD", "OD2", "M", "A:r", "I1", "I2", "J"), POSITIVE),
    "THETA": REAL, "A:ir": REAL,
    **dict.fromkeys([*BLANK.split(), "DMIG.TIN"], st.none()),
}  # fmt: skip
# Fields with a default or a blank that pyNastran wants given.
GIVEN = """
PID CQUADR CTRIAR CQUAD8 CTRIA6 CDAMP3 CBUSH1D|E MAT1|CM RBE2|CMA RROD|A PROD CONROD MPC DMIG PBAR
G1 CELAS1 CELAS2 CMASS1 CMASS2 CDAMP1 CDAMP2|S1 CELAS3 CELAS4 CMASS3 CMASS4 CDAMP3 CDAMP4|CP GRDSET
GS CFAST|KT1 PFAST|KT2 PFAST|KT3 PFAST
M CONM2|VALUE NSM NSML NSM1 NSML1|RID CORD2R CORD2C CORD2S|C MPC DMIG CSET1|G DMIG|CJ DMIG|N PARAM
V1 PARAM|IREC DTI|MASS DTI|FORCE DTI|LENGTH DTI|TIME DTI|NAME DTI DMIG"""
WANTED = {f"{c}.{w.split()[0]}" for w in re.split(r"[|\n]", GIVEN) for c in w.split()[1:]}
# Behind the fields of a definition: the texts of what no row of words tells.
BEHIND = {
    **dict.fromkeys(("PBARL", "PBEAML"), reals(3).map(lambda d: [*[None] * 4, *d])),
    **dict.fromkeys(("SPOINT", "SPC1", "ASET1", "OMIT1", "BSET1", "CSET1", "QSET1"), LIST),
    **dict.fromkeys(("NSM1", "NSML1"), GRIDS),
    "PBEAM": SECTION | st.builds(lambda a, b: [*a, "NO", "1.", *b], SECTION, SECTION),
    "PBUSH": reals(23).map(
        lambda v: ["K", *v[:6], None, "B", *v[6:12], None, "GE", *v[12:18], None,
                   "RCV", *v[18:22], None, None, None, "M", v[22]]
    ),
    "TABDMP1": points(6), "TABLEM1": points(5), "TABLEM2": points(5), "TABLEM3": points(4),
    "TABLEM4": st.lists(REAL, min_size=1, max_size=5).map(lambda a: [*[None] * 3, *a, "ENDT"]),
    "RBE1": st.builds(lambda n, m: [*n, *[None] * (7 - len(n)), "UM", *m], DOFS, DOFS),
    "RBE2": st.builds(lambda g, a: [*g, a], GRIDS, POSITIVE),
    "RBE3": st.builds(lambda w, c, g: [w, c, *g], POSITIVE, COMPONENTS, GRIDS),
}  # fmt: skip
BEFORE = {"DMIG": "DMIG,MADE,0,1,2,0\n"}

# PyNastran's attribute where its name is neither ours nor the guide's; `*` gathers that of every
# object (it makes several of one card), a routine gets the object.
NAMED = """
theta theta_mcid|zoffs zoffset|scalars nodes|integration integ|gm Gmi|GRID.id nid|SPOINT.nodes *nid
CONM2.m mass|CMASS2.m mass|CMASS4.m mass|PMASS.m mass|PBUSH.m mass|SPC.sid conid|SPC1.sid conid
MPC.sid conid|SPCADD.sid conid|MPCADD.sid conid|SUPORT1.sid conid|SUPORT.components Cs
SUPORT1.components Cs|ASET.nodes ids|OMIT.nodes ids|ASET1.nodes ids|OMIT1.nodes ids|NSM.ids *id
NSML.ids *id|NSM.values *value|NSML.values *value|NSM.type nsm_type|NSML.type nsm_type
NSM1.type nsm_type|NSML1.type nsm_type|PBARL.type beam_type|PBEAML.type beam_type|PBEAML.x xxb
PCOMP.mid mids|PCOMP.t thicknesses|PCOMP.theta thetas|PCOMP.sout souts|PCOMPG.mid mids
PCOMPG.t thicknesses|PCOMPG.theta thetas|PCOMPG.sout souts|PCOMPG.gplyid global_ply_ids
PSHELL.bending twelveIt3|PSHELL.shear tst|PBEAM.x xxb|PTUBE.od OD1|PBUSH.k Ki|PBUSH.b Bi
PBUSH.ge GEi|CONM2.g nid|CONM1.g nid|PARAM.n key|PARAM.v1 values|TEMPD.sid *sid|TEMPD.t *temperature
MAT2.damping ge_matrix|MAT8.e1 e11|MAT8.e2 e22|RBE1.gn Gni|RBE1.cn Cni|RBE1.cm Cmi|RBE3.cm Cmi
RBE3.components comps|RBE3.groups Gijs|DMIG.values Real"""
THEIRS = {
    **dict(pair.split() for pair in re.split(r"[|\n]", NAMED.strip())),
    **{f"{card}.x": lambda o: o.x if o.g0 is None else [o.g0, None, None]
       for card in ("CBAR", "CBEAM", "CBUSH", "CGAP", "CBEND", "BAROR", "BEAMOR")},
    **{f"{card}.points": lambda o: [o.e1, o.e2, o.e3] for card in ("CORD2R", "CORD2C", "CORD2S")},
    **dict.fromkeys([f"{n}SET{d}.nodes" for n in "BCQ" for d in ("", "1")], "ids"),
    **{f"DTI.{k}": lambda o, k=k: o.fields[k] for k in ("mass", "force", "length", "time")},
    "CONM1.m": lambda o: o.mass_matrix[np.tril_indices(6)],
    "PBUSH.rcv": lambda o: [o.sa, o.st, o.ea, o.et],
    "PBEAM.nsi": lambda o: [o.nsia, o.nsib], "PBEAM.cw": lambda o: [o.cwa, o.cwb],
    "PBEAM.m": lambda o: [o.m1a, o.m2a, o.m1b, o.m2b],
    "PBEAM.n": lambda o: [o.n1a, o.n2a, o.n1b, o.n2b],
    "TEMP.nodes": lambda o: list(o.temperatures), "TEMP.t": lambda o: [*o.temperatures.values()],
    "DMIG.gj": lambda o: o.GCj[0][0], "DMIG.cj": lambda o: o.GCj[0][1],
    "DMIG.nodes": lambda o: [g for g, _ in o.GCi],
    "DMIG.components": lambda o: [c for _, c in o.GCi],
}  # fmt: skip
APART = {
    "PBUSH.alpha": "pyNastran drops the line T", "PBUSH.apart": "no field of the card",
    "PARAM.v2": "pyNastran has one list of values",
    "RBAR1.tref": "pyNastran has no such field", "RROD.tref": "pyNastran has no such field",
    "DTI.irec": "pyNastran does not keep it", "DMIG.tin": "the header's in pyNastran",
    "DMIG.b": "none in a real matrix",
}  # fmt: skip
# Where blank, Nastran and pyNastran derive them of others; trueup does when the value is used.
DERIVED = """PSHELL.z1 PSHELL.z2 PCOMP.z0 PCOMPG.z0 PBAR.k1 PBAR.k2 PTUBE.t MAT1.g MAT1.nu MAT8.g1z
MAT8.g2z PGAP.kb PGAP.kt BAROR.offt BEAMOR.offt RBAR.cna RBAR.cma RBAR.cmb"""
SETS = ("SPOINT", "ASET1", "OMIT1", "BSET1", "CSET1", "QSET1", "SPC1", "NSMADD", "SPCADD", "MPCADD")


@st.composite
def cards(draw, card):
    """The texts of a card: fields drawn from its definition, some of those with defaults blank."""
    texts = []
    repeats = draw(st.integers(1, 2)) if card.repeated else 0
    vector = draw(st.lists(REAL, min_size=3, max_size=3) | st.just(["77777", None, None]))
    for turn, row in enumerate([card.fields, *[card.repeated] * repeats]):
        for field in row:
            named = (f"{card.name}.{field.name}", field.name, f"{field.name}:{field.kind}",
                     f"{field.attribute}:{field.kind}")  # fmt: skip
            drawn = next(
                (DRAWN[n] for n in named if n in DRAWN), KINDS.get(field.kind, st.integers(1, 900))
            )
            may = field.default is not MISSING and (field.default != "^" or turn > 1)
            may &= named[0] not in WANTED
            if field.attribute == "x" and field.kind == "ir":
                texts.append(vector[int(field.name[1]) - 1])
            elif field.kind in ("", "*"):
                texts += [None] * (field.kind == "")
            else:
                value = None if may and draw(st.booleans()) else draw(drawn)
                texts.append(str(100 * value + len(texts)) if isinstance(value, int) else value)
    return [*texts, *draw(BEHIND.get(card.name, st.just([])))]


def printed(name, texts, form):
    """The lines of a card in small, large or free fields."""
    while texts and texts[-1] is None:
        texts = texts[:-1]
    wide, columns = (4, 16) if form == "large" else (8, 8)
    star = "*" * (form == "large")
    lines = []
    for k in range(0, len(texts), wide):
        head, row = name + star if not k else star or "+", [t or "" for t in texts[k : k + wide]]
        fixed = f"{head:8}" + "".join(f"{t:{columns}}" for t in row)
        lines.append(",".join([head, *row]) if form == "free" else fixed)
    return "\n".join([*lines, ""])


def objects(model, name):
    """PyNastran's objects of one kind, wherever it keeps them."""
    held = [v for v in vars(model).values() if isinstance(v, dict | list) or hasattr(v, "type")]
    while held:
        part = held.pop(0)
        if isinstance(part, dict | list):
            held = [*(part.values() if isinstance(part, dict) else part), *held]
        elif getattr(part, "type", None) == name and not (name[:4] == "CORD" and not part.cid):
            yield part


def plain(value):
    """All values in one list: components are numbers; blanks, no text and no grid are None."""
    if isinstance(value, range | tuple | list | np.ndarray):
        return [v for part in value for v in plain(part)]
    if isinstance(value, str) and value and not value.strip(".0123456789"):
        value = float(value)
    return [None if value in ("", 0) else value]


def theirs(found, card, attribute):
    """What pyNastran's objects hold of one of our attributes, which may gather several fields."""
    named = THEIRS.get(f"{card.name}.{attribute}", THEIRS.get(attribute, attribute))
    if callable(named):
        return named(found[0])
    if named[0] == "*":
        return [getattr(each, named[1:]) for each in found]
    held = {key.lower().removesuffix("_table"): value for key, value in vars(found[0]).items()}
    fields = [f.name.lower() for f in card.fields if f.attribute == attribute]
    return held[named.lower()] if named.lower() in held else [held[name] for name in fields]


@pytest.mark.filterwarnings("ignore:The eig")  # it looks at the inertia of a CONM2
@pytest.mark.parametrize("name", READ)
@settings(max_examples=12, deadline=None, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_every_value_is_the_one_pynastran_reads(name, data, tmp_path_factory):
    text = printed(name, data.draw(cards(READ[name])), data.draw(words("small large free")))
    path = tmp_path_factory.getbasetemp() / "card.bdf"
    path.write_text(BEFORE.get(name, "") + text)
    bulk = read_deck(path).bulk
    ours, raw = [*bulk.table(name).values(), *bulk.listed(name)][-1], bulk.raw[name][-1]
    assert ours == bulk.reader.read(raw, fields_of(raw.lines))  # by columns and by itself
    model = bdf.BDF(debug=None)
    model.read_bdf(str(path), punch=True, xref=False)
    found = list(objects(model, name))
    compared = 0
    for attribute, value in ours._asdict().items():
        place, mine = f"{name}.{attribute}", plain(value)
        if place in APART or (place in DERIVED.split() and not any(mine)):
            continue
        pairs = list(zip_longest(mine, plain(theirs(found, READ[name], attribute))))
        if name in SETS:
            pairs = list(zip(*map(sorted, zip(*pairs, strict=True)), strict=True))
        assert all(a == b or a == pytest.approx(b, rel=1e-12) for a, b in pairs), (place, pairs)
        compared += len(pairs)
    assert compared

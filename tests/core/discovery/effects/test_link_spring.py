"""Springs between two places: what stretches them, and which are looked at."""

import numpy as np
import pytest

import trueup
from trueup.adapters.nastran.discovery.build_structure import build_structure
from trueup.core.discovery.effects.effect_kind import Scale
from trueup.core.discovery.effects.effect_numbers import EFFECTS
from trueup.core.discovery.effects.link_spring import KIND

PLATE = (
    "CEND\nBEGIN BULK\n"
    + "".join(f"GRID,{1 + i + 4 * j},,{0.1 * i},{0.1 * j},0.\n" for j in range(4) for i in range(4))
    + "".join(f"CQUAD4,{g},1,{g},{g + 1},{g + 5},{g + 4}\n" for g in (1, 2, 3, 5, 6, 7, 9, 10, 11))
    + "PSHELL,1,1,.003,1,,1\nMAT1,1,7.+10,,.3,2700.\nENDDATA\n"
)


@pytest.fixture
def structure(tmp_path):
    path = tmp_path / "it.bdf"
    path.write_text(PLATE)
    return build_structure(trueup.read_deck(path), ())


def links(structure):
    (found,) = KIND.places(structure, Scale(1.0, structure.model.geometry.size, 1.0, (1.0, 2.0)))
    return found


def motion(structure, u):
    """Return free coordinates of translations u (n_dof,) alone."""
    return np.linalg.lstsq(structure.model.expansion.toarray(), u, rcond=None)[0]


def test_a_link_feels_what_stretches_it_and_no_rigid_motion(structure):
    found, model = links(structure), structure.model
    x = model.geometry.xyz[model.geometry.index_of(model.dofs.node)]
    c = model.dofs.component
    straight = np.where(c == 2, 1.0, 0.0)
    turning = np.select([c == 1, c == 2, c == 6], [-x[:, 1], x[:, 0], 1.0])
    for u in (straight, turning):
        assert found.root @ motion(structure, u) == pytest.approx(0.0, abs=1e-9)
    stretched = found.root @ motion(structure, np.where(c == 1, x[:, 0], 0.0))
    a, b = found.ends_xyz[:, :3], found.ends_xyz[:, 3:]
    assert stretched == pytest.approx((b - a)[:, 0] ** 2 / np.linalg.norm(b - a, axis=1))


def test_every_pair_of_grids_neither_too_near_nor_too_far_stands_once(structure):
    found = links(structure)
    pairs = [tuple(sorted(w["grids"])) for w in found.where]
    assert len(set(pairs)) == len(pairs)
    ends, size = found.ends_xyz, structure.model.geometry.size
    low, high = (f * size for f in EFFECTS.link_lengths)
    x = structure.model.geometry.xyz
    far = np.linalg.norm(x[:, None] - x[None], axis=2)[np.triu_indices(len(x), 1)]
    assert len(pairs) == np.count_nonzero((far > low) & (far < high))
    assert found.xyz == pytest.approx(0.5 * (ends[:, :3] + ends[:, 3:]))


def test_links_are_near_each_other_where_both_their_ends_are(structure):
    found = links(structure)
    rows = {tuple(sorted(w["grids"])): i for i, w in enumerate(found.where)}
    cross, other = found.spots[rows[(1, 11)]], found.spots[rows[(3, 9)]]
    assert found.xyz[rows[(1, 11)]] == pytest.approx(found.xyz[rows[(3, 9)]])
    assert np.linalg.norm(cross - other) == pytest.approx(0.2)
    assert np.linalg.norm(cross - found.spots[rows[(2, 11)]]) == pytest.approx(0.1 / np.sqrt(2.0))


def test_links_near_one_end_at_grids_and_between_them(structure):
    found = links(structure)
    row = next(i for i, w in enumerate(found.where) if sorted(w["grids"]) == [1, 11])
    near = found.near(row, 4)
    first = {tuple(sorted(w["ends"][0])) for w in near.where}
    assert first == {(1,), (1, 2), (1, 5), (1, 2, 5, 6)}
    assert all(11 in w["ends"][1] for w in near.where)
    same = next(i for i, w in enumerate(near.where) if w["ends"] == [[1], [11]])
    assert near.root[[same]].toarray() == pytest.approx(found.root[[row]].toarray())


def test_a_link_between_grids_feels_the_mean_of_their_motion(structure):
    found, model = links(structure), structure.model
    row = next(i for i, w in enumerate(found.where) if sorted(w["grids"]) == [1, 11])
    near = found.near(row, 4)
    link = next(i for i, w in enumerate(near.where) if w["ends"] == [[1, 2], [11]])
    assert near.ends_xyz[link] == pytest.approx([0.05, 0.0, 0.0, 0.2, 0.2, 0.0])
    moved = np.where((model.dofs.node == 2) & (model.dofs.component == 1), 1.0, 0.0)
    pulled = near.root[[link]] @ motion(structure, moved)
    assert pulled == pytest.approx(-0.5 * 0.15 / np.hypot(0.15, 0.2))

"""A beam of many bars, one of which is softer than the deck says: that one is named."""

import json

import pytest

N, LENGTH = 24, 2400.0
SOFT, FACTOR = 10, 0.35


def beam(path, finer, soft):
    """Write a cantilever of N bars, each cut into `finer`; the bar `soft` is of less modulus."""
    n = N * finer
    lines = ["SOL 103", "CEND", "METHOD=1", "SPC=1", "BEGIN BULK", "EIGRL,1,,,14"]
    lines += ["PARAM,COUPMASS,1"] if finer > 1 else []
    lines += [f"GRID,{k + 1},,{LENGTH * k / n:.4f},0.,0." for k in range(n + 1)]
    for k in range(n):
        pid = 2 if k // finer + 1 == soft else 1
        lines.append(f"CBAR,{k + 1},{pid},{k + 1},{k + 2},0.,0.,1.")
    for number, modulus in ((1, 70000.0), (2, FACTOR * 70000.0)):
        lines.append(f"MAT1,{number},{modulus},,.33,2.7-9")
        lines.append(f"PBAR,{number},{number},600.,45000.,20000.,40000.")
    lines += ["SPC1,1,123456,1", "ENDDATA"]
    path.write_text("\n".join(lines) + "\n")


@pytest.mark.slow
@pytest.mark.parametrize("soft", [SOFT, None], ids=["one soft bar", "nothing"])
def test_one_soft_bar_of_many_in_line_is_named_and_sized(soft, tmp_path, call):
    """Truth: the same beam cut three times as fine, with consistent masses."""
    deck, truth, out = tmp_path / "beam.bdf", tmp_path / "truth.bdf", tmp_path / "run"
    beam(deck, 1, None)
    beam(truth, 3, soft)
    test = tmp_path / "truth.unv"
    assert call("solve", truth, "-n", 14, "--out", test, "--quiet").status == 0
    words = ("--deck-length-unit", "mm", "--out", out, "--quiet")
    assert call("discover", deck, test, *words).status == 0
    result = json.loads((out / "result.json").read_text())
    if soft is None:
        assert result["verdict"] in {"no_gap", "parameters_only"}
        assert result["findings"] == []
        return
    assert result["verdict"] == "effect"
    (finding,) = result["findings"]
    assert finding["kind"] == "local_stiffness"
    assert finding["where"]["elements"] == [SOFT]
    assert finding["magnitude"]["factor"] == pytest.approx(FACTOR, rel=0.15)

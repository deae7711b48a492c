"""The example of the library's interface runs as it is written, beside the duct's files."""

from __future__ import annotations

from pathlib import Path

import pytest

DUCT = Path(__file__).parents[2] / "fixtures" / "duct"
EXAMPLE = """
import trueup

deck = trueup.read_deck("duct.bdf")
test = trueup.read_test("duct_test.unv")
found = trueup.correlate(deck, test, deck_length_unit="mm")
better = trueup.update(deck, test, ["front = PBAR 11 I1, PBAR 11 I2"], residuals="frequencies", deck_length_unit="mm")
told = trueup.discover(deck, test, deck_length_unit="mm")
print(told.verdict, told.findings[0].sentence)
told.pairs            # a table: iterable of rows, .to_dict(), .to_csv(path), .to_pandas() where pandas is there
told.plot.mac()       # a matplotlib figure where matplotlib is there; likewise .shapes(), .frequencies(), .misfit()
told.deck.write("out/")
told.save("run/")     # the run folder
"""  # noqa: E501


@pytest.mark.slow
def test_the_example(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("matplotlib")
    for path in DUCT.iterdir():
        if path.is_file():
            (tmp_path / path.name).write_bytes(path.read_bytes())
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    exec(compile(EXAMPLE, "interface", "exec"), names)
    assert capsys.readouterr().out.startswith("effect ")
    assert (tmp_path / "out" / "duct.bdf").is_file()
    assert (tmp_path / "run" / "report.html").is_file()

"""``trueup parameters DECK [TEST]`` on the command line."""

from __future__ import annotations

import json


def test_a_deck_alone(call, duct):
    said = call("parameters", duct / "duct.bdf", "-p", "PSHELL * T", "-p", "PBAR 11:13 I1")
    assert said.status == 0, said.err
    assert "recommended: -p 'PSHELL * T'" in said.out
    assert "± alone" in said.out


def test_json_is_all_there_is_on_standard_output(call, duct):
    said = call("parameters", duct / "duct.bdf", duct / "duct_test.unv", "--json", "-", "-p",
                "PSHELL 1 T", "--residuals", "frequencies", "--deck-length-unit", "mm")  # fmt: skip
    told = json.loads(said.out)
    assert told["schema"] == "trueup/parameters/1"
    assert [c["name"] for c in told["candidates"]] == ["PSHELL 1 T"]


def test_no_deck_is_wrong_usage(call):
    assert call("parameters").status == 2

"""`trueup inspect` says what a universal file holds."""

import json

from trueup.adapters.universal import describe_universal


def test_one_screen(uff, write):
    text = uff.units() + uff.nodes_15([(1, 0.0, 0.0, 0.0), (2, 3.0, 4.0, 0.0)])
    text += uff.shape_55({1: (1, 2, 3)}, 12.5) + uff.shape_55({1: (1, 2, 3)}, 20.0)
    text += uff.function_58([1.0, 2.0, 3.0, 4.0]) + uff.function_58([1.0, 2.0], function=6)
    text += uff.dataset(2467, "groups") + uff.dataset(9999, "what")
    said = describe_universal(write(text))
    json.dumps(said)
    assert said["format"] == "universal file"
    assert said["contents"]["nodes"] == 2
    assert said["contents"]["size"] == 5.0
    assert said["contents"]["length_unit"] == "m"
    assert said["contents"]["modes"]["frequencies_hz"] == [12.5, 20.0]
    assert said["contents"]["frequency_responses"]["lines"] == 2
    assert said["contents"]["other_functions"] == {"coherence": 1}
    lines = text.split("\n")
    assert [(s["what"], lines[s["line"] - 1]) for s in said["skipped"]] == [
        ("dataset 2467 (permanent groups)", "  2467"),
        ("dataset 9999 (unknown to trueup)", "  9999"),
    ]
    counts = {d["number"]: d["datasets"] for d in said["datasets"]}
    assert counts == {15: 1, 55: 2, 58: 2, 164: 1, 2467: 1, 9999: 1}

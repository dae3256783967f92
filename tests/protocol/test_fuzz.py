from tests.fuzz import fuzz

BELIEVED = {"believed", "understood"}


def test_no_octets_break_a_decoder() -> None:
    found = fuzz(22_000)
    assert len(found) == 11
    for name, counts in found.items():
        assert counts.total() == 2000, name
        # Else the inputs would be too good, or too bad, to try anything.
        assert 150 < sum(counts[word] for word in BELIEVED) < 1850, name

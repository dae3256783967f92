"""Numbers behind the verdicts against those published for the paper's constants."""

from dataclasses import replace

import pytest

from gripperd.model import Chain, StaticMuscle
from gripperd.reproduce import Claim, Verdict, judge


@pytest.fixture(scope="module")
def found(chain: Chain) -> dict[str, Claim]:
    return {claim.key: claim for claim in judge(chain)}


@pytest.mark.parametrize(
    ("key", "verdict"),
    [
        ("straight-lines", Verdict.HOLDS),
        ("lines-coincide", Verdict.HOLDS),
        ("coincide-at-any-length", Verdict.ONLY_AT_REST),
        ("more-pressure-more-force", Verdict.HOLDS),
        ("rubber-ignores-pressure", Verdict.UNTESTABLE),
        ("rubber-rises-force-falls", Verdict.HOLDS),
        ("friction-is-a-force", Verdict.FAILS),
        ("elastic-force-clamps", Verdict.WEAK),
        ("one-current-holds-all", Verdict.UNTESTABLE),
    ],
)
def test_every_claim_gets_the_verdict_it_deserves(
    found: dict[str, Claim], key: str, verdict: Verdict
) -> None:
    assert found[key].verdict is verdict
    assert len(found) == 9


@pytest.mark.parametrize(
    ("key", "number", "published", "half_digit"),
    [
        ("straight-lines", "departure_at_rest_percent", 0.0, 1e-9),
        ("lines-coincide", "rubber_at_rest_N", 0.0, 0.0),
        ("lines-coincide", "rebraced_at_0_05_MPa_percent", 1.22, 0.005),
        ("lines-coincide", "rebraced_at_0_8_MPa_percent", 1.22, 0.005),
        ("lines-coincide", "as_printed_at_0_05_MPa_percent", 3.0, 0.05),
        ("lines-coincide", "as_printed_at_0_8_MPa_percent", 1.3, 0.05),
        ("lines-coincide", "as_printed_vented_N", 2.23, 0.005),
        ("coincide-at-any-length", "shift_at_h_0_05_N", 124.5, 0.05),
        ("more-pressure-more-force", "slope_N_per_kPa", 2.57542, 5e-6),
        ("more-pressure-more-force", "force_at_0_4_MPa_N", 1030.2, 0.05),
        ("rubber-ignores-pressure", "rubber_at_h_0_10_N", 186.3, 0.05),
        ("rubber-ignores-pressure", "variation_with_pressure_N", 0.0, 1e-9),
        ("rubber-ignores-pressure", "wall_thinning_at_h_0_25_percent", 23.2, 0.05),
        ("rubber-rises-force-falls", "rubber_at_h_0_05_of_h_0_25_percent", 50, 0.5),
        ("rubber-rises-force-falls", "free_contraction_gauge", 0.2579, 5e-5),
        ("rubber-rises-force-falls", "free_contraction_absolute", 0.2286, 5e-5),
        ("friction-is-a-force", "as_printed_in_m_and_Pa_N", 15.82, 0.005),
        ("friction-is-a-force", "as_printed_in_mm_and_MPa_N", 5.43, 0.005),
        ("friction-is-a-force", "rebraced_in_m_and_Pa_N", 12.77, 0.005),
        ("friction-is-a-force", "rebraced_in_mm_and_MPa_N", 12.77, 0.005),
        ("elastic-force-clamps", "force_at_h_0_05_N", 521.4, 0.05),
        ("elastic-force-clamps", "force_at_h_0_20_N", 65.5, 0.05),
        ("elastic-force-clamps", "fall_from_geometry_N", 341, 0.5),
        ("elastic-force-clamps", "fall_from_rubber_N", 115, 0.5),
        ("elastic-force-clamps", "share_of_rubber_percent", 25, 0.5),
        ("one-current-holds-all", "share_of_span_percent", 41.9, 0.05),
        ("one-current-holds-all", "pressure_of_a_500_kPa_valve_kPa", 209, 0.5),
        ("one-current-holds-all", "pressure_of_a_600_kPa_valve_kPa", 251, 0.5),
        ("one-current-holds-all", "pressure_of_a_900_kPa_valve_kPa", 377, 0.5),
        ("one-current-holds-all", "samples_reached", 4, 0),
        ("one-current-holds-all", "largest_grip_N", 47.6, 0.05),
        ("one-current-holds-all", "smallest_grip_N", 5.6, 0.05),
    ],
)
def test_the_number_is_the_published_one(
    found: dict[str, Claim],
    key: str,
    number: str,
    published: float,
    half_digit: float,
) -> None:
    # Published numbers are rounded, so half their last digit is allowed.
    assert found[key].numbers[number] == pytest.approx(published, rel=0, abs=half_digit)


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("lines-coincide", ["0 N", "1.22 %", "1.3 %", "3.0 %", "2.23 N"]),
        ("coincide-at-any-length", ["124 N"]),
        ("rubber-rises-force-falls", ["0.258", "0.229", "50 %"]),
        ("friction-is-a-force", ["15.82 N", "5.43 N", "12.77 N"]),
        ("elastic-force-clamps", ["521 N", "65.5 N", "341 N", "115 N", "25 %"]),
        ("one-current-holds-all", ["41.9 %", "0.209 / 0.251 / 0.377 MPa", "4 of 4"]),
    ],
)
def test_the_sentence_says_the_numbers(
    found: dict[str, Claim], key: str, words: list[str]
) -> None:
    assert [word for word in words if word not in found[key].finding] == []


def with_muscle(chain: Chain, **constants: float) -> Chain:
    muscle = replace(chain.muscle, **constants)
    return replace(chain, static=StaticMuscle(muscle, chain.static.effects))


def test_a_stiff_bladder_is_what_makes_one_signal_clamp_all(chain: Chain) -> None:
    stiff = with_muscle(chain, elastic_modulus=10e6)
    verdicts = {claim.key: claim.verdict for claim in judge(stiff)}
    assert verdicts["elastic-force-clamps"] is Verdict.HOLDS


def test_without_rubber_the_lines_coincide_at_any_length(chain: Chain) -> None:
    bare = with_muscle(chain, elastic_modulus=1e-3)
    verdicts = {claim.key: claim.verdict for claim in judge(bare)}
    assert verdicts["coincide-at-any-length"] is Verdict.HOLDS


def test_with_real_rubber_on_fibre_friction_the_lines_part(chain: Chain) -> None:
    rough = with_muscle(chain, friction_coefficient=0.02)
    verdicts = {claim.key: claim.verdict for claim in judge(rough)}
    assert verdicts["lines-coincide"] is Verdict.FAILS

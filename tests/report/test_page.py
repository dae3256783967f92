import re
from dataclasses import replace
from html.parser import HTMLParser

import pytest

from gripperd.demo.hidden import Hidden
from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.readings.recording import Contradiction, Kind, Rejection
from gripperd.diagnose.search.rivalry import Contest, Place
from gripperd.diagnose.statement import summary
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.diagnose.verdict.extrapolation import Extrapolation
from gripperd.diagnose.verdict.key import public
from gripperd.diagnose.verdict.named import Estimate
from gripperd.diagnose.verdict.next_experiment import Proposal
from gripperd.errors import InputError
from gripperd.model.effect import Signal
from gripperd.report import page
from gripperd.report.rows import contenders, overruled, ranking
from gripperd.report.trace import traces
from gripperd.reproduce.extra import not_installed
from tests.demonstration import example
from tests.diagnose.offered import around, bump

VOID = {"meta", "link", "br", "img", "wbr", "hr", "input"}


class Checked(HTMLParser):
    """Every element is closed, and nothing is fetched."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.fetched: list[str] = []
        self.names: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.fetched += [
            f"{tag} {key}={given[key]}"
            for key in ("src", "href", "data", "srcset")
            if given.get(key) and not str(given[key]).startswith("#")
        ]
        if name := given.get("id"):
            self.names.append(name)
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def written(diagnosis: Diagnosis) -> str:
    return page(diagnosis, model="as-drawn", program="0.1.0")


@pytest.fixture(scope="module")
def creep() -> Diagnosis:
    return example(Hidden.CREEP)[1]


@pytest.fixture(scope="module")
def text(creep: Diagnosis) -> str:
    return written(creep)


def test_it_needs_nothing_but_a_browser(text: str) -> None:
    checked = Checked()
    checked.feed(text)
    assert checked.open == []
    assert checked.fetched == []
    assert "<script" not in text
    assert "@import" not in text
    assert "url(http" not in text


def test_no_two_elements_share_a_name(text: str) -> None:
    checked = Checked()
    checked.feed(text)
    assert len(checked.names) == len(set(checked.names))


def test_it_says_the_verdict_first(text: str, creep: Diagnosis) -> None:
    heading = re.search(r"<h1>(.*?)</h1>", text)
    assert heading is not None
    assert heading.group(1) == summary(creep)


@pytest.mark.parametrize("figure", ["map", "over_time", "against", "held_out"])
def test_it_shows_where_and_how_much_better(text: str, figure: str) -> None:
    assert f'<figure id="{figure}">' in text


@pytest.mark.parametrize(
    ("verdict", "said"),
    [
        (Verdict.NONE, "No stretch of the recording is off by more than its noise."),
        (Verdict.NAMED, "No single stretch is off by more than chance"),
    ],
)
def test_that_no_stretch_is_off_alone_is_not_that_nothing_is(
    creep: Diagnosis, verdict: Verdict, said: str
) -> None:
    text = written(replace(creep, verdict=verdict, where=()))
    assert text.count(" stretch is") + text.count("No stretch of") == 1
    assert said in text


def test_a_stretch_says_which_way_it_went(text: str) -> None:
    """The muscle creeps under load most as it lengthens."""
    assert ">way</th>" in text
    assert ">extending</td>" in text


def test_the_gap_is_four_numbers(text: str, creep: Diagnosis) -> None:
    assert creep.main is not None
    gap = creep.gaps[creep.main]
    for size in (gap.before, gap.recalibrated, gap.after, gap.noise_floor):
        assert f'<span class="value">{size:.3g} N</span>' in text


def test_a_bar_is_as_long_as_its_number(text: str, creep: Diagnosis) -> None:
    assert creep.main is not None
    gap = creep.gaps[creep.main]
    share = 100 * gap.after / gap.before
    assert f'style="width:{share:.1f}%"' in text


def test_the_same_diagnosis_gives_the_same_page(text: str, creep: Diagnosis) -> None:
    assert written(creep) == text


def test_an_open_question_comes_with_the_sweep_that_answers_it(
    creep: Diagnosis,
) -> None:
    plan = {
        "title": "slow sweep",
        "t_s": [0.0, 20.0],
        "pressure_kPa": [0.0, 300.0],
        "contraction": [0.0, 0.0],
    }
    proposal = Proposal(Kind.ISOMETRIC, "separates A from B", "slow sweep", plan)
    rival = replace(creep.named[0], equivalents=("valve_lag",))
    text = written(
        replace(creep, verdict=Verdict.AMBIGUOUS, named=(rival,), proposal=proposal)
    )
    assert '<figure id="plan">' in text
    assert "pressure_kPa: [0.0, 300.0]" in text
    assert "<code>valve_lag</code>" in text


def test_what_was_left_out_is_told_and_cannot_break_the_page(creep: Diagnosis) -> None:
    recording = replace(
        creep.recording,
        rejected=(Rejection("<b>run", "force_N", 7, "frozen"),),
        contradictions=(Contradiction(("a",), ("b",), "force_N", 12.5, "N", 2.0),),
    )
    text = written(replace(creep, recording=recording))
    assert "7 of force_N in &lt;b&gt;run, frozen" in text
    assert "12.5 N" in text


def test_what_was_left_out_for_one_reason_is_one_line(creep: Diagnosis) -> None:
    found = [Rejection(f"run_{n}", "force_N", n, "frozen") for n in range(1, 8)]
    text = written(
        replace(creep, recording=replace(creep.recording, rejected=tuple(found)))
    )
    said = "28 of force_N in run_1, run_2, run_3, run_4 and 3 more, frozen"
    assert text.count("Left out:") == 1
    assert said in text


def test_a_number_is_no_finer_than_its_doubt_nor_beyond_its_bound(
    creep: Diagnosis,
) -> None:
    (found,) = creep.named
    estimates = dict(found.parameters) | {"slow": Estimate(0.15, 0.0312, -0.15, 0.15)}
    text = written(replace(creep, named=(replace(found, parameters=estimates),)))
    cells = ("slow", "0.150", "0.031", "0.089 to 0.150, at its bound")
    assert "".join(f"<td>{cell}</td>" for cell in cells) in text


def test_what_was_chosen_has_no_interval(creep: Diagnosis) -> None:
    entry = replace(creep.named[0], parameters={"fresh": Estimate(0.0, 0.0)})
    text = written(replace(creep, named=(entry,)))
    assert "<td>fresh</td><td>0</td><td>chosen</td><td>-</td>" in text
    assert "<td>of</td><td>pull</td><td>chosen</td><td>-</td>" in text


def test_no_p_value_is_0(creep: Diagnosis) -> None:
    sure = tuple(replace(one, p_value=0.0) for one in creep.where)
    text = written(replace(creep, where=sure))
    assert "<td>&lt; 1e-99</td>" in text
    assert "0e+00" not in text


def test_what_came_nearest_is_not_drawn_as_found(creep: Diagnosis) -> None:
    open_still = replace(creep, verdict=Verdict.UNEXPLAINED)
    assert "with what was found" not in written(open_still)
    drawn = [str(one) for one in traces(open_still, Signal.FORCE)[0].expected]
    assert drawn == ["as it came", "better constants", "with what came nearest"]


def at_cost(rival: Rival, cost: float) -> Rival:
    return replace(rival, fit=replace(rival.fit, cost=cost))


def _rivalled(told: Diagnosis, rival: Rival) -> Contest:
    """Who could be meant as well, and nobody else."""
    return Contest(told.contest.best, (Place(told.found.null, (rival,)),))


def test_what_adds_nothing_is_no_explanation_of_its_own(creep: Diagnosis) -> None:
    best = creep.contest.best
    other = next(one for one in creep.found.rivals if "creep" not in one.names)
    more = replace(best, candidates=(*best.candidates, *other.candidates))
    name = " + ".join(sorted(map(public, more.names)))
    # Half the cost is evidence; a twentieth of a nat is nothing.
    for loss, is_told in ((0.0, False), (0.08, False), (4.0, True), (-4.0, True)):
        rival = at_cost(more, best.fit.cost + loss)
        contest = _rivalled(creep, rival)
        found = replace(creep.found, rivals=())
        text = written(replace(creep, contest=contest, found=found))
        assert (f"{name}</th>" in text) is is_told


@pytest.mark.parametrize(("margin", "is_told"), [(2.0, False), (82.0, True)])
def test_it_says_within_how_much_nothing_is_told_apart(
    creep: Diagnosis, margin: float, *, is_told: bool
) -> None:
    entry = replace(creep.named[0], equivalents=("fatigue",))
    contest = replace(creep.contest, margin=margin)
    text = written(replace(creep, named=(entry,), contest=contest))
    assert "cannot tell <code>creep</code> from <code>fatigue</code>" in text
    assert ("up to 82&nbsp;nat behind" in text) is is_told


def test_it_says_why_more_evidence_may_be_passed_over(
    creep: Diagnosis, text: str
) -> None:
    assert "ahead by evidence alone" not in text
    ahead = at_cost(creep.found.rivals[0], creep.contest.best.fit.cost - 1e3)
    contest = _rivalled(creep, ahead)
    assert "ahead by evidence alone" in written(replace(creep, contest=contest))


def test_chart_and_table_do_not_disagree(creep: Diagnosis) -> None:
    chart = ranking(creep)
    assert chart is not None
    gains = {bar.label: float(bar.value.replace("\u202f", "")) for bar in chart.lines}
    behind = {name: float(nat) for name, nat, _ in contenders(creep).rows}
    both = gains.keys() & behind.keys()
    assert {"creep", "pressure_hysteresis", "presliding_hysteresis"} <= both
    for name in both:
        assert gains["creep"] - gains[name] == pytest.approx(behind[name], abs=1.1)


def test_a_name_that_is_withdrawn_is_ahead_of_what_is_told(creep: Diagnosis) -> None:
    text = written(replace(creep, verdict=Verdict.UNEXPLAINED))
    assert "behind what came nearest [nat]" in text
    assert "changes no reading by 0.5% of full scale" in text


@pytest.mark.parametrize(("ahead", "said"), [(0.05, False), (0.2, True)])
def test_a_tenth_of_a_nat_is_no_lead(
    creep: Diagnosis, ahead: float, said: bool
) -> None:
    best = creep.contest.best
    contest = _rivalled(creep, at_cost(best, best.fit.cost - 2 * ahead))
    assert overruled(replace(creep, contest=contest)) is said


def test_a_correction_has_a_picture_and_is_called_no_physics(creep: Diagnosis) -> None:
    text = written(
        replace(creep, verdict=Verdict.UNEXPLAINED, corrections=(bump(), around()))
    )
    checked = Checked()
    checked.feed(text)
    assert checked.open == []
    assert '<figure id="correction_force">' in text
    assert '<figure id="correction_grip">' in text
    assert "A correction that is no physics" in text
    assert "<td>does not matter</td><td>0 to 0.2</td>" in text


def test_without_a_correction_none_is_mentioned(text: str) -> None:
    assert "no physics" not in text


def test_extrapolation_stands_apart_with_its_sweeps(
    creep: Diagnosis, text: str
) -> None:
    assert "Extrapolation" not in text
    assert creep.main is not None
    gap = replace(creep.gaps[creep.main], before=77.7)
    beyond = Extrapolation(("fast_sweep",), {creep.main: gap})
    told = written(replace(creep, extrapolation=beyond))
    assert "fast_sweep" in told
    assert "which the gap above leaves out" in told
    both = Extrapolation(creep.held_out[:1], beyond.gaps)
    assert '<span class="value">77.7 N</span>' in told
    told = written(replace(creep, extrapolation=both))
    assert "which the gap above leaves out" not in told
    assert "some of which the gap above has in it as well" in told


def test_a_recording_that_contradicts_itself_gets_no_verdict_in_disguise(
    creep: Diagnosis,
) -> None:
    found = Contradiction(("a",), ("b",), "force_N", 12.5, "N", 2.0)
    text = written(
        replace(
            creep, verdict=Verdict.UNUSABLE, named=(), gaps={}, main=None, where=(),
            recording=replace(creep.recording, contradictions=(found,)),
        )
    )  # fmt: skip
    assert "force_N of a differs from that of b by 12.5 N" in text
    assert "Which, and how sure" not in text
    assert "Constants of the model" not in text


def test_where_nothing_was_found_nothing_is_said_to_be(creep: Diagnosis) -> None:
    text = written(replace(creep, verdict=Verdict.NONE, named=()))
    assert '<figure id="map">' in text
    assert "with what was found" not in text


def test_without_anything_held_out_it_is_still_a_page(creep: Diagnosis) -> None:
    checked = Checked()
    text = written(
        replace(creep, verdict=Verdict.NONE, named=(), gaps={}, main=None, where=())
    )
    checked.feed(text)
    assert checked.open == []
    assert '<figure id="map">' not in text


@pytest.mark.parametrize(
    ("package", "kind"), [("matplotlib.figure", InputError), ("numpy", ImportError)]
)
def test_only_a_missing_extra_is_the_reader_s_to_install(
    package: str, kind: type[Exception]
) -> None:
    said = not_installed(ModuleNotFoundError(name=package), "report")
    assert isinstance(said, kind)
    if kind is InputError:
        assert str(said) == ("drawing needs matplotlib: pip install 'gripperd[report]'")

"""A diagnosis as the document that files and replies have, in the units of its keys."""

from collections.abc import Sequence
from math import floor, log10
from typing import TypeAlias

from gripperd.diagnose.correction.document import correction_document
from gripperd.diagnose.diagnosis import Diagnosis
from gripperd.diagnose.fit.candidates import WRONG
from gripperd.diagnose.readings.columns import BY_QUANTITY, Column
from gripperd.diagnose.readings.recording import Contradiction
from gripperd.diagnose.statement import statement, summary
from gripperd.diagnose.verdict.figures import UNLIKELY
from gripperd.diagnose.verdict.gap import Gap
from gripperd.diagnose.verdict.key import keys_of, number, public
from gripperd.diagnose.verdict.named import Named
from gripperd.diagnose.verdict.next_experiment import Proposal
from gripperd.diagnose.verdict.recalibrated import Recalibrated, recalibrated
from gripperd.diagnose.verdict.region import region_document
from gripperd.diagnose.verdict.where import Finding
from gripperd.model.effect import Signal

Document: TypeAlias = dict[str, object]


def document(diagnosis: Diagnosis, *, model: str, program: str) -> Document:
    """Write a diagnosis; the same diagnosis gives the same document.

    Numbers are finite or null. Without a name nothing stands under ``effects``; what
    came nearest stands under ``nearest``.

    Parameters
    ----------
    diagnosis
        What was found.
    model
        Name of the model it is about.
    program
        Version of the program.
    """
    entries = [_effect(diagnosis, entry) for entry in diagnosis.named]
    named = diagnosis.verdict.establishes
    recording = diagnosis.recording
    return {
        "verdict": diagnosis.verdict.value,
        "statement": summary(diagnosis),
        "effects": entries if named else [],
        "nearest": [] if named else entries,
        "where": [_finding(one) for one in diagnosis.where],
        "gap": gap_document(diagnosis, diagnosis.main) if diagnosis.main else None,
        "gaps": {
            BY_QUANTITY[signal.value].name: gap_document(diagnosis, signal)
            for signal in diagnosis.gaps
        },
        "next_experiment": _next(diagnosis.proposal),
        "rejected_samples": [
            {
                "run": one.run,
                "column": one.column,
                "count": one.count,
                "reason": one.reason,
            }
            for one in recording.rejected
        ],
        "unexplained": {
            "signature": list(diagnosis.signature),
            "correction": "gp" if diagnosis.corrections else "none",
            "corrections": [correction_document(one) for one in diagnosis.corrections],
        },
        "constants": [
            _constant(one)
            for one in recalibrated(diagnosis.found.problem, diagnosis.told)
            if diagnosis.found.problem.shown(one.constant.moves)
        ],
        "untested": dict(diagnosis.untested),
        "contradictions": [_contradiction(one) for one in recording.contradictions],
        "remarks": list(recording.remarks),
        "recording": {"name": recording.name, "sha256": recording.digest},
        "model": model,
        "seed": diagnosis.seed,
        "program": program,
    }


def _constant(one: Recalibrated) -> Document:
    # Beyond a thousandth of its deviation a fit is a matter of rounding.
    digits = 3 - floor(log10(one.std)) if one.std > 0 else None
    return {
        "name": public(f"{WRONG}{one.constant.path}").removeprefix(WRONG),
        "model": number(one.model),
        "tolerance": number(one.tolerance),
        "fit": number(one.fit if digits is None else round(one.fit, digits)),
        "std": number(float(f"{one.std:.4g}")),
    }


def gap_document(diagnosis: Diagnosis, signal: Signal) -> Document:
    """Write the gap of one signal, and beyond what was searched its own."""
    column, beyond = BY_QUANTITY[signal.value], diagnosis.extrapolation
    return {
        "signal": column.name,
        "unit": column.unit,
        **_gap(diagnosis.gaps[signal], column, diagnosis.held_out),
        "extrapolation": (
            _gap(beyond.gaps[signal], column, beyond.runs)
            if beyond and signal in beyond.gaps
            else None
        ),
    }


def _gap(gap: Gap, column: Column, runs: Sequence[str]) -> Document:
    sizes = {
        "rmse_before": gap.before,
        "rmse_recalibrated": gap.recalibrated,
        "rmse_after": gap.after,
        "noise_floor": gap.noise_floor,
    }
    return {
        **{key: number(value / column.scale) for key, value in sizes.items()},
        "ci95_after": [number(end / column.scale) for end in gap.ci95_after],
        "heldout_runs": list(runs),
    }


def _effect(diagnosis: Diagnosis, entry: Named) -> Document:
    keys, column = keys_of(entry), BY_QUANTITY[entry.signal.value]
    return {
        "name": public(entry.name),
        "stage": entry.stage,
        "statement": statement(diagnosis, entry),
        "parameters": {
            keys[name].text: {
                "value": number(estimate.value / keys[name].factor),
                "std": number(estimate.std / keys[name].factor),
            }
            for name, estimate in entry.parameters.items()
        },
        "chosen": entry.chosen,
        "size": {
            "signal": column.name,
            "unit": column.unit,
            "rms": number(entry.size / column.scale),
        },
        "equivalents": [public(name) for name in entry.equivalents],
        "evidence": {
            "p_value": number(max(entry.p_value, UNLIKELY)),
            "delta_bic": number(entry.delta_bic),
            "heldout_gain": number(entry.heldout_gain),
        },
    }


def _finding(finding: Finding) -> Document:
    column = BY_QUANTITY[finding.signal.value]
    return {
        "stage": finding.stage,
        "signal": column.name,
        "run": finding.run,
        "region": region_document(finding.region),
        "bias": number(finding.bias / column.scale),
        "std": number(finding.std / column.scale),
        "unit": column.unit,
        "p_value": number(max(finding.p_value, UNLIKELY)),
    }


def _next(proposal: Proposal | None) -> Document | None:
    if proposal is None:
        return None
    return {
        "kind": proposal.kind.value if proposal.kind else None,
        "why": proposal.why,
        "plan": dict(proposal.plan),
    }


def _contradiction(found: Contradiction) -> Document:
    return {
        "runs": list(found.runs),
        "others": list(found.others),
        "column": found.column,
        "difference": number(found.difference),
        "unit": found.unit,
        "spread": number(found.spread),
    }

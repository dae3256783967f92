from pathlib import Path

import pytest

from gripperd.errors import GripperdError, InputError
from gripperd.service.child import Judged, Read, work

pytestmark = pytest.mark.anyio


async def test_a_worker_s_refusal_is_raised_here(tmp_path: Path) -> None:
    (tmp_path / "rig.csv").write_text("run,t_s,force_lbf\nup,0,1\n")
    with pytest.raises(InputError, match=r'^rig\.csv: column "force_lbf"'):
        await work("read", "rig.csv", reply=Read, folder=tmp_path)


async def test_a_worker_with_a_bad_end_is_no_answer(tmp_path: Path) -> None:
    # The seed is no number, which no client can ask for.
    with pytest.raises(GripperdError, match="came to a bad end, status 1"):
        await work("diagnose", "a", "b", "c", reply=Judged, folder=tmp_path)


async def test_what_lies_beside_a_recording_is_not_run(tmp_path: Path) -> None:
    (tmp_path / "numpy.py").write_text("raise SystemExit(3)")
    (tmp_path / "rig.csv").write_text("")
    with pytest.raises(InputError, match=r"^rig\.csv: is empty"):
        await work("read", "rig.csv", reply=Read, folder=tmp_path)

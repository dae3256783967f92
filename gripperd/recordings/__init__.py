"""Recordings in files: read, judged and written; CSV and Parquet."""

from gripperd.recordings.reader import read_recording
from gripperd.recordings.writer import write_recording

__all__ = ["read_recording", "write_recording"]

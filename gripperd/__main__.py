"""Lets ``python -m gripperd`` do what ``gripperd`` does."""

from gripperd.cli import main

main()

"""Which effects: what is added, what it must be worth, and who else it could be."""

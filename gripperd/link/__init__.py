"""The messages between the processes, over one Unix socket each."""

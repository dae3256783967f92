"""gripperd drives a gripper powered by a pneumatic artificial muscle.

The layers, top to ground; each imports only what stands below it::

    cli            the commands a person types
    service        REST: the only place that knows HTTP
    store          versions of models                     | recordings  CSV and Parquet
    config         settings, profiles, models: the only reader of files
    link           the messages between the processes
    control        what to do and when it is allowed      | reproduce  the paper, redone
                                                          | diagnose   what is missing
    drivers        talk to hardware over a bus            | bench      a simulated rig
    protocol       bytes <-> values, no I/O               | effects    what the textbook
                                                          |            leaves out
    model          textbook physics: pure functions of SI values
    signals        what was commanded and what was measured
    errors, units
"""

__version__ = "0.1.0"

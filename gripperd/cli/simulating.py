"""The command that runs the simulated rig alone, with any modules on any line."""

from pathlib import Path
from typing import Annotated

import typer

from gripperd.cli.app import ConfigFile, app
from gripperd.cli.daemon import Tcp, host_and_port, log_to_stderr
from gripperd.errors import InputError

ModuleNames = Annotated[
    list[str] | None,
    typer.Option(
        "--module",
        help="NAME[:UNIT[:RANGE]] of a module, or the .yaml that describes it; again"
        " for each. Without it, those of the settings.",
    ),
]
Rtu = Annotated[
    Path | None,
    typer.Option("--rtu", help="Modbus RTU: a port, or where to link a new pty."),
]
DconPort = Annotated[
    Path | None, typer.Option("--dcon", help="The same for DCON and ADAM ASCII.")
]
ItvPort = Annotated[
    Path | None, typer.Option("--itv", help="The same for an SMC regulator.")
]
Baud = Annotated[
    int, typer.Option("--baud", help="Speed of the serial line, kept on a pty too.")
]
Even = Annotated[
    bool, typer.Option("--even", help="Even parity on the serial line; else none.")
]
Checksum = Annotated[
    bool, typer.Option("--checksum", help="Lines of DCON end in a checksum.")
]
Object = Annotated[
    str | None,
    typer.Option("--object", help="Profile of what lies between the open jaws."),
]
FaultTexts = Annotated[
    list[str] | None,
    typer.Option(
        "--fault",
        help="KIND[:KEY=NUMBER,...] that the next request meets; again for each"
        " request. Keys are code, delay_ms, unit, times.",
    ),
]
Chance = Annotated[
    float,
    typer.Option("--fault-chance", help="Of a fault of each further request, 0 to 1."),
]


@app.command()
def bench(  # noqa: PLR0913  (its options)
    config: ConfigFile = None,
    module: ModuleNames = None,
    tcp: Tcp = None,
    rtu: Rtu = None,
    dcon: DconPort = None,
    itv: ItvPort = None,
    baud: Baud = 9600,
    even: Even = False,
    checksum: Checksum = False,
    object_: Object = None,
    fault: FaultTexts = None,
    fault_chance: Chance = 0.0,
) -> None:
    """Run the simulated rig alone: analog modules on Modbus TCP or a serial line."""
    from gripperd.cli import bench_line, bench_process, processes
    from gripperd.config import load_settings

    grammar = bench_line.Grammar
    places = {grammar.RTU: rtu, grammar.DCON: dcon, grammar.ITV: itv}
    port = bench_line.port(places, baud, parity=even, checksum=checksum)
    if port is not None and tcp is not None:
        message = f"--tcp and --{port.grammar} are given; a bench has one line"
        raise InputError(message, key="--tcp")
    line = bench_line.BenchLine(
        fitted=bench_line.fitted(module or ()),
        tcp=host_and_port("--tcp", tcp),
        port=port,
        object=object_,
        faults=tuple(map(bench_line.wire_fault, fault or ())),
        chance=fault_chance,
    )
    settings = load_settings(config)
    log_to_stderr()
    processes.run_process(bench_process.bench(settings, line))

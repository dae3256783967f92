"""A Modbus device with pyModbusTCP; says "ready" once it listens."""

import signal
import sys

from pyModbusTCP.server import DataBank, ModbusServer

from tests.interop import contents


def main(kind: str, port: str) -> None:
    assert kind == "tcp"
    bank = DataBank(
        coils_size=contents.BITS,
        d_inputs_size=contents.BITS,
        h_regs_size=contents.REGISTERS,
        i_regs_size=contents.REGISTERS,
    )
    bits, registers = range(contents.BITS), range(contents.REGISTERS)
    bank.set_coils(0, [contents.coil(place) == 1 for place in bits])
    bank.set_discrete_inputs(0, [contents.discrete(place) == 1 for place in bits])
    bank.set_holding_registers(0, [contents.holding(place) for place in registers])
    bank.set_input_registers(0, [contents.input_(place) for place in registers])
    server = ModbusServer("127.0.0.1", int(port), no_block=True, data_bank=bank)
    server.start()
    print("ready", flush=True)
    signal.pause()


if __name__ == "__main__":
    main(*sys.argv[1:])

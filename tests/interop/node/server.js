// A Modbus device with modbus-serial: server.js tcp PORT | rtu PATH BAUD.
// Says "ready" once it listens. What it holds at first is told in contents.py.
"use strict";

const { ServerSerial, ServerTCP } = require("modbus-serial");

const BITS = 2000;
const REGISTERS = 5000;
const ILLEGAL_ADDRESS = 2;
const UNIT = 1;

const numbers = (count, value) => Array.from({ length: count }, (_, i) => value(i));
const coils = numbers(BITS, (i) => i % 3 === 0);
const discrete = numbers(BITS, (i) => i % 5 === 0);
const holding = numbers(REGISTERS, (i) => 1000 + i);
const input = numbers(REGISTERS, (i) => 8000 + i);

function checked(table, address) {
    if (address >= table.length) {
        throw { modbusErrorCode: ILLEGAL_ADDRESS };
    }
    return address;
}

const read = (table) => (address) => table[checked(table, address)];
const write = (table) => (address, value) => {
    table[checked(table, address)] = value;
};

const contents = {
    getCoil: read(coils),
    setCoil: write(coils),
    getDiscreteInput: read(discrete),
    getHoldingRegister: read(holding),
    setRegister: write(holding),
    getInputRegister: read(input),
};

const [kind, place, baud] = process.argv.slice(2);
// The library ends a frame after 30 ms of silence unless told otherwise.
const server = kind === "tcp"
    ? new ServerTCP(contents, { host: "127.0.0.1", port: Number(place), unitID: UNIT })
    : new ServerSerial(contents, {
        path: place, baudRate: Number(baud), unitID: UNIT, interval: 5,
    });
server.on("initialized", () => console.log("ready"));
server.on("socketError", () => {});

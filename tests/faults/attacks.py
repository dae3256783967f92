"""Requests and files made to do harm; none of them may have its way."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from urllib.parse import quote

from tests.faults.held import COMMANDS

JSON = {"Content-Type": "application/json"}
RELEASE = b'{"type": "release"}'
DEEP = 30_000
"""Levels of nesting that still fit into a body."""


@dataclass(frozen=True, slots=True)
class Ask:
    """A request, octet by octet."""

    method: str
    target: str
    """As it stands in the first line."""
    headers: Mapping[str, str] = field(default_factory=dict)
    body: bytes = b""
    host: str | None = "localhost"


NAMES = (
    "..",
    "../../../etc/passwd",
    "..%2F..%2F..%2Fetc%2Fpasswd",
    "..%5C..%5Cgripperd.yaml",
    "%2E%2E",
    "/etc/passwd",
    "%00",
    "raw_egg%00.yaml",
    "raw_egg%0D%0AX-Evil:%201",
    "%FF%FE",
    quote("\u202egge_war"),
    quote("raw_egg\u200b"),
    quote("\uff52aw_egg"),
    quote("<script>alert(1)</script>"),
    quote("' OR 1=1 --"),
    quote("${jndi:ldap://evil.example}"),
    "%s%n%x",
    "x" * 10_000,
)
NAMED = (
    ("GET", "/profiles/{}"),
    ("PUT", "/profiles/{}"),
    ("DELETE", "/profiles/{}"),
    ("POST", "/profiles/{}/evaluate"),
    ("GET", "/grippers/{}"),
    ("POST", "/grippers/{}/disable"),
    ("GET", "/grippers/g0/commands/{}"),
    ("POST", "/grippers/g0/faults/{}/acknowledge"),
    ("GET", "/recordings/{}"),
    ("GET", "/models/{}"),
    ("POST", "/models/{}/activate"),
    ("GET", "/diagnoses/{}"),
)
BODIES: Mapping[str, bytes] = {
    "PUT": b'{"diameter_mm": 40, "stiffness_N_per_mm": 10, "mass_g": 58,'
    b' "pad_friction": 0.5, "damage_force_N": 35}',
    "POST": b"{}",
}


def names() -> Iterator[Ask]:
    """Every hostile name at every place for one."""
    for method, place in NAMED:
        for name in NAMES:
            body = BODIES.get(method, b"")
            headers = JSON if body else {}
            yield Ask(method, "/v1" + place.format(name), headers, body)


DOCUMENTS = (
    b'{"type": "grasp", "profile": "raw_egg", "force_N": NaN}',
    b'{"type": "grasp", "profile": "raw_egg", "force_N": Infinity}',
    b'{"type": "grasp", "profile": "raw_egg", "force_N": -1e999}',
    b'{"type": "grasp", "profile": "raw_egg", "force_N": 1' + b"0" * 5000 + b"}",
    b'{"type": "grasp", "profile": "raw_egg", "force_N": "5"}',
    b'{"type": "grasp", "profile": "../../etc/passwd"}',
    b'{"type": "grasp", "profile": "raw_egg\\u0000"}',
    b'{"type": "grasp", "profile": "\\ud800"}',
    b'{"type": "grasp", "profile": {"$ne": null}}',
    b'{"type": "release", "type": "release"}',
    b'{"type": "grasp", "type": "release"}',
    b'{"type": "release", "__proto__": {"type": "vent"}}',
    b'{"type": ["release"]}',
    b'[{"type": "release"}]',
    b'"release"',
    b"null",
    b"0",
    RELEASE + RELEASE,
    RELEASE + b"\x00",
    b"\xef\xbb\xbf" + RELEASE,
    '{"type": "release"}'.encode("utf-16"),
    b"\xff" * 100,
    b"[" * DEEP,
    b"[" * DEEP + b"]" * DEEP,
    b'{"type":' * (DEEP // 5) + b"0" + b"}" * (DEEP // 5),
    b'{"' + b"x" * 60_000 + b'": 1}',
)
TAKERS = (
    ("POST", COMMANDS),
    ("PUT", "/grippers/g0/lease"),
    ("POST", "/profiles"),
    ("PUT", "/profiles/hostile"),
    ("PUT", "/bench/object"),
    ("PUT", "/bench/faults"),
    ("PUT", "/bench/wire-faults"),
    ("POST", "/grippers/g0/faults/f1/acknowledge"),
    ("POST", "/predictions"),
)


def documents() -> Iterator[Ask]:
    """Every hostile document to everything that takes one."""
    for method, place in TAKERS:
        for document in DOCUMENTS:
            yield Ask(method, f"/v1{place}", JSON, document)


HOSTS = (
    "evil.example",
    "localhost.evil.example",
    "127.0.0.1.nip.io",
    "localhost@evil.example",
    "evil.example#localhost",
    "evil.example:8765",
    "127.1",
    "0x7f.0.0.1",
    "2130706433",
    "localhost.",
    "local\thost",
    "[::1",
    "\u217cocalhost",
    "",
)


def hosts() -> Iterator[Ask]:
    """Releases in the name of others, as after DNS rebinding; no name, and two."""
    for host in HOSTS:
        yield Ask("POST", f"/v1{COMMANDS}", JSON, RELEASE, host)
    yield Ask("POST", f"/v1{COMMANDS}", JSON, RELEASE, None)
    twice = {**JSON, "host": "evil.example"}
    yield Ask("POST", f"/v1{COMMANDS}", twice, RELEASE)


ORIGINS = (
    "http://evil.example",
    "http://localhost.evil.example",
    "http://localhost@evil.example",
    "http://localhost:3000",
    "http://127.0.0.1",
    "null",
    "file://",
    "http://[",
    "chrome-extension://abcdefgh",
    "",
)
SIMPLE = ("text/plain", "application/x-www-form-urlencoded", "multipart/form-data", "")


def origins() -> Iterator[Ask]:
    """Releases from pages of others."""
    for origin in ORIGINS:
        yield Ask("POST", f"/v1{COMMANDS}", {**JSON, "Origin": origin}, RELEASE)
        yield Ask("OPTIONS", f"/v1{COMMANDS}", {"Origin": origin})


def simple() -> Iterator[Ask]:
    """Releases as a browser sends them anywhere without asking before."""
    for kind in SIMPLE:
        yield Ask("POST", f"/v1{COMMANDS}", {"Content-Type": kind}, RELEASE)
    for method in ("GET", "HEAD", "TRACE", "CONNECT", "release", "POST /x"):
        yield Ask(method, "/v1/grippers/g0/stop")


SOUND = b"up,0.00,100,0.05,20"
TABLES: Mapping[str, bytes] = {
    "formula as force": b"up,0.00,100,0.05,=HYPERLINK(1)",
    "NaN as time": b"up,nan,100,0.05,20",
    "NUL": b"up,0.00,100,0.05,2\x000",
    "two megabytes in a cell": b"up,0.00,100,0.05," + b"x" * 2_000_000,
    "open quote": b'up,0.00,100,0.05,"20',
    "too many cells": SOUND + b",1" * 100_000,
    "no UTF-8": b"up,0.00,100,0.05,\xff\xfe",
    "escapes": b"up,0.00,100,0.05,\x1b[2J\x1b]0;evil\x07",
}
"""First row of a recording that cannot be read."""
KEPT: Mapping[str, tuple[bytes, int]] = {
    "1e400": (b"up,0.00,100,0.05,1e400", 1),
    "two megabytes of digits": (b"up,0.00,100,0.05," + b"9" * 2_000_000, 1),
    "formula as name": (b"=cmd|' /C calc'!A0,0.00,100,0.05,20", 0),
}
"""First row of a recording that can, and how many samples of it are left out."""
COLUMNS = b"run,t_s,pressure_kPa,contraction,force_N\n"


def table(row: bytes) -> bytes:
    """A recording that begins with such a row."""
    rows = (b"up,%.2f,%d,0.05,%d\n" % (0.1 * n, 100 + n, 20 + n) for n in range(1, 40))
    return COLUMNS + row + b"\n" + b"".join(rows)


TEXTS: Mapping[str, bytes] = {
    "billion laughs": b"a: &a [x, x, x]\nb: &b [*a, *a, *a]\nc: [*b, *b, *b]\n",
    "tag that runs": b"grippers: !!python/object/apply:os.system [reboot]\n",
    "tag of its own": b"grippers: !evil {}\n",
    "key twice": b"grippers: {}\ngrippers: {}\n",
    "merge key": b"grippers: {<<: {g0: {}}}\n",
    "nested deeply": b"grippers: " + b"[" * 100_000,
    "nested deeply, in lines": b"".join(b" " * n + b"a:\n" for n in range(1000)),
    "two megabytes": b"# " + b"x" * 2_000_000 + b"\n",
    "NUL": b"grippers: a\x00b\n",
    "no UTF-8": b"grippers: \xff\xfe\n",
    "escape beyond Unicode": b'grippers: "\\UFFFFFFFF"\n',
    "endless number": b"grippers: " + b"9" * 100_000 + b"\n",
    "1e999": b"grippers: 1e999\n",
    "two documents": b"grippers: {}\n---\ngrippers: {}\n",
    "a list": b"- grippers\n",
    "nothing": b"",
    "another file": b"profiles: ../../../../../../etc\n",
    "a device": b"profiles: /dev/zero\n",
}
"""Whole files of settings."""

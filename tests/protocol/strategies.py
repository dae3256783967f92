"""Whatever can be asked, for hypothesis."""

from hypothesis import strategies as st

from gripperd.protocol import itv
from gripperd.protocol.dcon import Ask, Good, Lead
from gripperd.protocol.modbus import Read, Request, Table, Write, WriteCoil

words = st.integers(0, 0xFFFF)
# Every unit that a serial line can address.
units = st.integers(1, 255)

reads = st.sampled_from(Table).flatmap(
    lambda table: st.builds(
        Read, units, st.just(table), words, st.integers(1, table.most)
    )
)
single_writes = st.builds(Write, units, words, st.tuples(words), st.booleans())
long_writes = st.builds(
    Write, units, words, st.lists(words, min_size=2, max_size=123).map(tuple)
)
requests: st.SearchStrategy[Request] = st.one_of(
    reads, single_writes, long_writes, st.builds(WriteCoil, units, words, st.booleans())
)

asks = st.builds(
    Ask,
    st.integers(0, 255),
    st.text(st.characters(min_codepoint=0x20, max_codepoint=0x7E), max_size=20),
    st.sampled_from(Lead),
    st.sampled_from(Good),
    st.none() | st.integers(0, 20),
)

itv_requests: st.SearchStrategy[itv.Request] = st.one_of(
    st.sampled_from(itv.Query), st.builds(itv.Set, st.integers(0, 1023))
)


def found(request: Request) -> st.SearchStrategy[tuple[int, ...]]:
    """What a device may answer a request with."""
    if isinstance(request, WriteCoil):
        return st.just((int(request.on),))
    if isinstance(request, Write):
        return st.just(request.values)
    each = st.integers(0, 1) if request.table.of_bits else words
    return st.lists(each, min_size=request.count, max_size=request.count).map(tuple)

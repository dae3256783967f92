from gripperd.control.output import Output


def adopted(current: float) -> Output:
    output = Output()
    output.adopt(current)
    return output


def test_what_was_adopted_is_not_written() -> None:
    output = adopted(0.0107)
    assert output.adopted
    assert output.change() is None


def test_a_change_is_written_once() -> None:
    output = adopted(0.004)
    output.current = 0.005
    assert output.change() == 0.005
    assert not output.adopted
    assert output.change() is None


def test_less_than_half_a_count_is_no_change() -> None:
    output = adopted(0.004)
    output.current = 0.0040004
    assert output.change() is None
    output.current = 0.0040006
    assert output.change() == 0.0040006


def test_small_changes_add_up() -> None:
    output = adopted(0.004)
    module = 0.004
    for step in range(1, 101):
        output.current = 0.004 + step * 1e-7
        module = output.change() or module
        assert abs(module - output.current) < 0.5e-6
    assert module > 0.004009


def test_one_strange_read_back_may_have_crossed_a_write() -> None:
    output = adopted(0.004)
    assert not output.foreign(0.012)
    assert not output.foreign(0.004)
    assert not output.foreign(0.012)
    assert output.foreign(0.012)


def test_the_rounding_of_the_module_is_nobody_else() -> None:
    output = adopted(0.004)
    output.current = 0.0107004
    output.change()
    assert not any(output.foreign(0.0107) for _ in range(10))

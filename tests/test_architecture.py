from importlinter.cli import lint_imports


def test_each_layer_imports_only_what_stands_below_it() -> None:
    assert lint_imports(no_cache=True) == 0

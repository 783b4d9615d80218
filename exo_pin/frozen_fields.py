"""Fields of frozen dataclasses: how `__post_init__` sets those that it converts."""


def set_fields(record: object, **values: object) -> None:
    """Set fields of a frozen dataclass from its own `__post_init__`, before anything else sees the record.

    A field is annotated with the type that it has from then on. The initialiser stays the generated one, so
    `dataclasses.replace`, pickling and `inspect.signature` work as for every other dataclass.

    Args:
        record: The dataclass instance that is being made.
        **values: Field name -> converted value.
    """
    for name, value in values.items():
        object.__setattr__(record, name, value)

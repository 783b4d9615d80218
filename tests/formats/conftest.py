"""Fixtures of the formats' tests."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def lab():
    """The module `lab_files.py`: writers of files that this package only reads."""
    spec = importlib.util.spec_from_file_location("lab_files", Path(__file__).with_name("lab_files.py"))
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module

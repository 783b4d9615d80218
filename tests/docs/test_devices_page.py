"""docs/devices.md lists every device with the number of its motors."""

import re
from pathlib import Path

from exo_pin.devices import DEVICES

PAGE = (Path(__file__).parents[2] / "docs" / "devices.md").read_text("utf-8")


def test_the_first_table_has_every_device_and_its_motors():
    table = PAGE.partition("## What a device is")[2].partition("\n## ")[0]
    rows = re.findall(r"^\| `(\w+)` \| (\d+) \|", table, flags=re.MULTILINE)
    assert rows == [(name, str(device.motors)) for name, device in DEVICES.items()]

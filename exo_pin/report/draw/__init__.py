"""Drawings as SVG: charts, tables of numbers, stick figures, devices. They know no document."""

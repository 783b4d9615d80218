"""Drawings as SVG: charts, tables of numbers, stick figures."""

"""Sections of a report: each turns results of other rooms into paragraphs, tables and figures."""

"""Sections of a report: each turns results into words, tables and figures."""

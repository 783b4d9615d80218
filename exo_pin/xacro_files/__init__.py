"""Xacro files of one's own: expanded by xacro in a process that can read their package alone."""

from exo_pin.xacro_files.expansion import expanded as expanded

"""Documents as values, and what renders them as HTML or Markdown."""

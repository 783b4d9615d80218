"""Documents as values, and their rendering as HTML or Markdown. They hold drawings and know no results."""

"""The page that the browser shows, and its export as one offline file."""

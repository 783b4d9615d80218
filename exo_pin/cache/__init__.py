"""Cache of results between runs, in the user's cache folder: private, sealed with a key, optional.

The folder is `$XDG_CACHE_HOME/exo_pin` (`~/.cache/exo_pin`), or what `EXO_PIN_CACHE` names; if that is empty,
nothing is kept. It may be deleted at any time (`exo-pin cache --clear`). It holds walks of patients: the last
pictures of `replay`.
"""

from exo_pin.cache.place import VARIABLE, folder, refusal, switched_off
from exo_pin.cache.store import MOST_RESULTS, Kept, clear, contents, keep, key, recall, refused_entry

__all__ = [
    "MOST_RESULTS",
    "VARIABLE",
    "Kept",
    "clear",
    "contents",
    "folder",
    "keep",
    "key",
    "recall",
    "refusal",
    "refused_entry",
    "switched_off",
]

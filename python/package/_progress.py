"""What becomes of the argument `progress`."""

import contextlib
import sys


class _Line:
    """Tells on one line of the terminal how far a call is, where there is no tqdm."""

    def __init__(self):
        self._shown = ""

    def __call__(self, stage, done, total, share):
        text = stage if share is None else f"{stage}: {share:.0%}"
        if text != self._shown:
            print(f"\r{text:<60}", end="", file=sys.stderr, flush=True)
            self._shown = text

    def close(self):
        if self._shown:
            print(f"\r{'':<60}\r", end="", file=sys.stderr, flush=True)


class _Bar:
    """A bar of tqdm's."""

    def __init__(self, tqdm):
        self._bar = tqdm(
            total=100, bar_format="{desc}: {percentage:3.0f}%|{bar}| {elapsed}", leave=False
        )

    def __call__(self, stage, done, total, share):
        if stage:
            self._bar.set_description_str(stage, refresh=False)
        if share is None and total:
            share = done / total
        if share is not None:
            self._bar.update(round(100 * share, 1) - self._bar.n)

    def close(self):
        self._bar.close()


@contextlib.contextmanager
def told(progress):
    """The callable, or None, that a call tells how far it is."""
    if progress is None or progress is False:
        yield None
    elif progress is True:
        try:
            from tqdm.auto import tqdm
        except ImportError:
            shown = _Line()
        else:
            shown = _Bar(tqdm)
        with contextlib.closing(shown):
            yield shown
    elif callable(progress):
        yield progress
    else:
        raise TypeError(f"progress: must be a callable, True or None, not {progress!r}")

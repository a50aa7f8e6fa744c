"""Curves over time: the few shapes that all movements of the demo library are drawn with.

Times are in seconds, signals have one row a frame. Every shape begins and ends at rest.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from mlmg_runtime.arrays import FloatArray

FRAME_RATE = 30.0


def frame_times(n_frames: int) -> FloatArray:
    """Return the times in seconds of the frames of a clip, shape (n_frames,)."""
    return np.arange(n_frames) / FRAME_RATE


def eased(share: FloatArray) -> FloatArray:
    """Return the way made at `share` of the time: how a hand gets from rest to rest with the least jerk.

    The minimum-jerk polynomial of Flash and Hogan (1985); `share` is held within 0 and 1.
    """
    u = np.clip(share, 0.0, 1.0)
    return np.asarray(u**3 * (10.0 - 15.0 * u + 6.0 * u**2))


def glided(share: FloatArray, start: float = 0.34, stop: float = 0.29) -> FloatArray:
    """Return the way made at `share` of the time at a speed that is even between `start` and `stop`.

    For a foot in the air, whose speed is much less of a bell than a hand's. `start` and `stop` are the shares
    of the time in which it gathers and loses speed, together at most 1.
    """
    u = np.clip(share, 0.0, 1.0)
    starting = np.minimum(u, start)
    stopping = np.maximum(u - (1.0 - stop), 0.0)
    lost = 0.5 * (starting + start / np.pi * np.sin(np.pi * starting / start))
    lost += 0.5 * (stopping - stop / np.pi * np.sin(np.pi * stopping / stop))
    return np.asarray((u - lost) / (1.0 - 0.5 * (start + stop)))


def bump(share: FloatArray) -> FloatArray:
    """Return a hill that rises from 0 at `share` 0 to 1 at 0.5 and is 0 again from 1 on."""
    return np.sin(np.pi * np.clip(share, 0.0, 1.0)) ** 2


def plateau(times_s: FloatArray, rise_s: float, top_s: float, fall_s: float, end_s: float) -> FloatArray:
    """Return a track, (n_frames,), that is 0, eases to 1 from `rise_s` to `top_s`, and back by `end_s`."""
    return keyed(times_s, [rise_s, top_s, fall_s, end_s], [0.0, 1.0, 1.0, 0.0])


def keyed(
    times_s: FloatArray, key_times_s: Sequence[float], keys: Sequence[FloatArray | float], lead_s: float = 0.0
) -> FloatArray:
    """Return a track that eases from key to key, as a sum of overlapping movements (Flash and Henis, 1991).

    Parameters
    ----------
    times_s : array, shape (n_frames,).
    key_times_s : rising; before the first and after the last, the track stays in the key.
    keys : numbers, or arrays of one shape.
    lead_s : how long before a key's time the movement to the next begins: with 0 the track comes to rest in
        each key, with more it cuts the corners.

    Returns
    -------
    array, shape (n_frames, *shape of a key).
    """
    at, values = np.asarray(key_times_s, dtype=float), np.asarray(keys, dtype=float)
    begin = at[:-1] - lead_s
    if np.any(begin >= at[1:]) or np.any(np.diff(at) < 0.0):
        raise ValueError(f"key times must rise: {key_times_s}")
    moved = eased((times_s[:, None] - begin) / (at[1:] - begin))
    return np.asarray(values[0] + np.tensordot(moved, np.diff(values, axis=0), axes=1))


def relaxing(
    times_s: FloatArray, events_s: Sequence[float], values: Sequence[float], rest: float, relax_s: float
) -> FloatArray:
    """Return a track that has a given value at each event and returns to `rest` where there is time.

    Parameters
    ----------
    times_s : array, shape (n_frames,).
    events_s, values : rising times, and the value at each.
    relax_s : how long the way to or from rest takes; nearer events are joined directly.
    """
    key_times, keys = [-1e6], [rest]
    for event_s, value in zip(events_s, values, strict=True):
        if event_s - key_times[-1] > 2.0 * relax_s:
            key_times += [key_times[-1] + relax_s, event_s - relax_s]
            keys += [rest, rest]
        key_times.append(event_s)
        keys.append(value)
    return keyed(times_s, [*key_times, key_times[-1] + relax_s], [*keys, rest])


def blurred(signal: FloatArray, width_s: float) -> FloatArray:
    """Return `signal`, (n_frames, ...), averaged under a Hann bell of `width_s` a side; ends are held."""
    reach = max(1, round(width_s * FRAME_RATE))
    bell = np.hanning(2 * reach + 3)[1:-1]
    return filtered(signal, bell / bell.sum())


def filtered(signal: FloatArray, kernel: FloatArray) -> FloatArray:
    """Return `signal`, (n_frames, ...), convolved over frames with a kernel of odd length; ends are held."""
    reach = len(kernel) // 2
    padded = np.pad(signal, [(reach, reach), *[(0, 0)] * (signal.ndim - 1)], mode="edge")
    return np.asarray(sliding_window_view(padded, len(kernel), axis=0) @ kernel[::-1])


def smooth_floor(ceiling: FloatArray, width_s: float) -> FloatArray:
    """Return a smooth track, (n_frames,), that touches `ceiling` in places and is nowhere above it.

    The lowest value within `width_s` to either side, averaged over the same reach: no frame's average holds a
    value above that frame's ceiling.
    """
    reach = max(1, round(width_s * FRAME_RATE))
    lowest = sliding_window_view(np.pad(ceiling, reach, mode="edge"), 2 * reach + 1).min(axis=-1)
    return blurred(np.asarray(lowest), width_s)


def delayed(signal: FloatArray, delay_s: float) -> FloatArray:
    """Return `signal`, (n_frames,), so much later; its first value is held until then."""
    frames = np.arange(len(signal), dtype=float)
    return np.interp(frames - delay_s * FRAME_RATE, frames, signal)

"""What real sensors add to a quantity: noise, drift, rounding, samples, delay, losses.

    channel = sinew.sensors.Channel(noise=1e-4, rate=100, delay=0.02, seed=1)
    channel.offer(time, value)
    channel.value, channel.time, channel.fresh

The sensors of a scene have such a channel each (docs/sensors.md).
"""

from ._core import Channel

__all__ = ["Channel"]
Channel.__module__ = "sinew.sensors"

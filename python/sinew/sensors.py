"""Model of a sensor channel: noise, drift, quantisation, sampling, delay and dropout.

    channel = sinew.sensors.Channel(noise=1e-4, rate=100, delay=0.02, seed=1)
    channel.offer(time, value)
    channel.value, channel.time, channel.fresh

Every sensor of a scene has such a channel (docs/sensors.md).
"""

from ._core import Channel

__all__ = ["Channel"]
Channel.__module__ = "sinew.sensors"

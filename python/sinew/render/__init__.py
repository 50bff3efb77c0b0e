"""Pictures and videos without a window: sinew.render(sim)."""

from .camera import Camera
from .renderer import Renderer

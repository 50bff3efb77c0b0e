"""The tasks, one class each."""

from .arm_swing_up import ArmSwingUp
from .contact import ContactTask
from .crawl import Crawl
from .grasp import Grasp
from .trunk import TrunkTask
from .trunk_damp import TrunkDamp
from .trunk_follow import TrunkFollow
from .trunk_hold import TrunkHold
from .trunk_reach import TrunkReach

__all__ = ["ArmSwingUp", "ContactTask", "Crawl", "Grasp", "TrunkDamp", "TrunkFollow", "TrunkHold", "TrunkReach", "TrunkTask"]

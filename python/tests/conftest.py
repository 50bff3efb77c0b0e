"""Scenes for the tests; each test gets new ones."""

from pathlib import Path

import pytest
import sinew

SCENES = Path(__file__).parent / "scenes"


@pytest.fixture
def scene():
    """Path of the small finger with four cables."""
    return SCENES / "finger.yaml"


@pytest.fixture
def sim(scene):
    """The finger, at rest."""
    return sinew.load(scene)


@pytest.fixture
def follow():
    """Path of the scene of the finger with a controller."""
    return SCENES / "follow.yaml"

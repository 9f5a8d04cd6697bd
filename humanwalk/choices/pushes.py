"""Pushes against the body, which act with every controller."""

from humanwalk.choices.world import World
from humanwalk.walking.push import PushParameters


def add_pushes(world: World, parameters: PushParameters) -> None:
    """Add `pushes`; its forces are empty where the scenario has none."""
    pushes = world.add("pushes", world.sources.pushes(world.plant, parameters, world.seed))
    world.spatial_forces.append(pushes.GetOutputPort("spatial_forces"))

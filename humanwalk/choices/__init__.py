"""The choices of a scenario: contact, controller, actuation and pushes, each of which adds itself to a diagram."""

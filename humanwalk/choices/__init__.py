"""The choices of a scenario: contact, controller and actuation. Each adds itself to a diagram."""

from humanwalk.choices.actuation import ACTUATIONS, Actuation, PdActuation
from humanwalk.choices.balanced import BalancedController
from humanwalk.choices.contact import CONTACTS, Contact, PointContact
from humanwalk.choices.controller import Controller
from humanwalk.choices.recorded import RecordedController
from humanwalk.choices.thesis import ThesisController

CONTROLLERS: dict[str, type[Controller]] = {
    "thesis": ThesisController,
    "balanced": BalancedController,
    "recorded": RecordedController,
}
"""The controllers that a scenario can name."""

__all__ = [
    "ACTUATIONS",
    "CONTACTS",
    "CONTROLLERS",
    "Actuation",
    "BalancedController",
    "Contact",
    "Controller",
    "PdActuation",
    "PointContact",
    "RecordedController",
    "ThesisController",
]

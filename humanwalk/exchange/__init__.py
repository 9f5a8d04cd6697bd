"""Export of a run to other programs: OpenSim, motion-capture software (C3D), MATLAB, spreadsheets."""

from humanwalk.exchange.export import FORMATS, export_run, forces_left_out

__all__ = ["FORMATS", "export_run", "forces_left_out"]

"""Views of a run: replay, video, plots, report and diagram pictures."""

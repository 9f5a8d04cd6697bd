"""python -m humanwalk: the command line."""

from humanwalk.run.cli import main

main()

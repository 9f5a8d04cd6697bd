"""python -m humanwalk: the command line."""

from humanwalk.cli.main import main

main()

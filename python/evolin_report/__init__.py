"""Tables, plots and pages from the result directories of `evolin run` and `evolin benchmark`.

Python 3.8 upwards; numpy for comparisons, matplotlib for plots, both imported only where needed.
"""

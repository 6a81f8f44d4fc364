"""cellcolor: the fewest lift-offs of a robot arm over a surface, with a proof.

The problem is that of Yang, Valls Miro, Lai, Wang and Xiong, "Cellular Decomposition for
Non-repetitive Coverage Task with Minimum Discontinuities" (2020). Terms are the paper's.
"""

__version__ = "0.1.0"

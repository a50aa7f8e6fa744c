"""The demo library's motions, made by code, so that everything can be tried without any motion capture.

A person is moved as a person moves: feet are planted by `footwork` and reached by `inverse_kinematics`, the
body floats above them as an inverted pendulum, trunk and arms answer (`carriage`), and what is meant (`gait`,
`idle`, `talk`, `dance`, `wave`) comes on top. Each clip's noise has a fixed seed: the clips never change.
"""

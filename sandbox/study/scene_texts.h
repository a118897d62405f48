// Scenes that several studies play; what they vary they set themselves.
#pragma once

namespace shatterbox::sandbox::study {

/// A glass bauble, `whole`, over a stone floor, turned so that its round side meets it. Not said: where it
/// is, its velocity and edge length.
inline constexpr const char* kBaubleText = R"([[material]]
name = "stone"
like = "concrete"
friction = 0.45
restitution = 0.35
[[body]]
name = "floor"
kind = "plane"
material = "stone"
[[body]]
name = "whole"
kind = "shell"
shape = "ornament"
radius = 0.04
material = "ornament_glass"
thickness = 0.0005
rotation = [24, 0, 38]
)";

/// A pane of a metre, `whole`, held at its border, and a steel ball of 1 kg before it. Not said: the ball's
/// velocity, along -z, and the pane's edge length.
inline constexpr const char* kHeldPaneText = R"([scene]
gravity = [0, 0, 0]
[[body]]
name = "whole"
kind = "shell"
shape = "pane"
width = 1
height = 1
thickness = 0.004
material = "glass"
support = "edge"
[[body]]
name = "ball"
kind = "sphere"
radius = 0.0315
material = "steel"
position = [0.03, 0.02, 0.035]
)";

}  // namespace shatterbox::sandbox::study

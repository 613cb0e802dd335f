// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace arris {

inline constexpr const char* kScene = R"(title = "Every key"
duration = 0.5
[time]
step = 0.01
integrator = "bdf2"
[cloth]
size = [0.4, 0.3]
resolution = [3, 2]
pattern = "cross"
pattern_angle = 17.0
folds = [ { line = [[0.2, 0.0], [0.2, 0.3]], degrees = 40 } ]
translate = [0.0, 0.0, 0.5]
rotate = { axis = [1, 0, 0], degrees = 20 }
velocity = [0.1, 0.0, -0.2]
[cloth.material]
preset = "silk"
density = 0.1
damping = 0.001
thickness = 1e-3
[[pin]]
material = [[0, 0], [0, 0.3]]
follow = "plate"
release = 0.4
[[pin]]
material = [[0.4, 0], [0.4, 0]]
keyframes = [ { time = 0.0 }, { time = 0.2, translate = [0, 0.1, 0], rotate = { axis = [0, 0, 1], degrees = 5 } } ]
directions = ["x", "z"]
[[pull]]
material = [[0.4, 0.3], [0.4, 0.3]]
force = [0, 0, -0.1]
start = 0.1
stop = 0.21
[gravity]
acceleration = [0, 0, -9.81]
[wind]
velocity = [2, 1, 0]
gust = { amplitude = 0.5, frequency = 2, seed = 3 }
[[obstacle]]
name = "plate"
box = [0.2, 0.2, 0.1]
translate = [0, 0, 0.1]
motion = { velocity = [0, 0, 0.1], angular_velocity = [0, 0, 1], start = 0.1, stop = 0.3 }
[[obstacle]]
name = "row"
teeth = { count = 3, pitch = 0.1, height = 0.05, width = 0.2, tip_degrees = 60 }
feature_angle = 20
[[obstacle]]
wire = [[0, 0, -0.1], [0.1, 0, -0.1], [0.1, 0.1, -0.1]]
closed = true
[[obstacle]]
points = [[0, 0, -0.2]]
scale = 2.0
[[obstacle]]
name = "body"
file = "body.obj"
translate = [0, 0, -3]
deform = { file = "body.pc2", frames_per_second = 20, start = 0.1, speed = 1.5, first = 0, last = 2, interpolation = "linear" }
[[probe]]
name = "tip"
material = [0.4, 0.1]
[solver]
tolerance = 1e-9
[output]
frames_per_second = 24
formats = ["obj", "viewer"]
)";

inline constexpr const char* kPanels = R"(title = "Every key of panels"
duration = 0.1
[cloth]
edge_length = 0.1
[cloth.assembly]
speed = 0.6
settle = 0.1
unsewn = "keep"
frames = true
[[cloth.panel]]
name = "front"
outline = [[0, 0], [0.3, 0], [0.3, 0.3], [0, 0.3]]
edges = [{ edge = 2, label = "top", control = [[0.15, 0.35]] }]
translate = [-0.15, 0.12, 0.0]
rotate = { axis = [1, 0, 0], degrees = 90 }
[[cloth.panel]]
name = "back"
fabric = "heavy"
outline = [[0, 0], [0.3, 0], [0.3, 0.3], [0, 0.3]]
translate = [-0.15, -0.12, 0.0]
rotate = { axis = [1, 0, 0], degrees = 90 }
[[cloth.panel]]
name = "pocket"
outline = [[0, 0], [0.1, 0], [0.1, 0.1], [0, 0.1]]
translate = [-0.05, 0.2, 0.1]
rotate = { axis = [1, 0, 0], degrees = 90 }
[[cloth.seam]]
join = [["front", 0, 3], ["back", 0, 3]]
[[cloth.seam]]
join = [["front", 1, 2], ["back", 1, 2]]
order = 1
[[cloth.seam]]
join = [["pocket", 0, 1], ["front", 2, 3]]
as = "tie"
order = 2
[[fabric]]
name = "heavy"
density = 0.4
[[pin]]
label = "top"
[[probe]]
name = "p"
panel = "back"
material = [0.1, 0.2]
[self_contact]
start = "untangle"
[gravity]
[[obstacle]]
name = "post"
box = [0.05, 0.05, 1.0]
start = "untangle"
)";

}  // namespace arris

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/obstacle_input/formats/input_file.h"
#include "geometry/obstacle_input/usd/usda_scanner.h"

namespace arris {

/// Where a value stands in the text, and how many groups it has (points of an array).
struct UsdValue {
    UsdPlace place;
    std::size_t groups = 0;
};

struct UsdSample {
    double time_code = 0.0;
    UsdValue value;
};

/// An attribute of a prim that moves a mesh: `points`, or an operation `xformOp:...`.
struct UsdAttribute {
    std::string name;
    std::string type;                ///< "point3f[]", "double3"
    std::optional<UsdValue> value;   ///< where there are no samples
    std::vector<UsdSample> samples;  ///< time codes ascend
};

struct UsdPrim {
    std::string name, type;
    int parent = -1;
    std::vector<UsdAttribute> attributes;
    std::vector<std::string> xform_order;  ///< names of operations, the one nearest to the points last
    std::string composition;               ///< a word by which the prim takes more from elsewhere; else empty
    bool has_skeleton = false;             ///< bound by UsdSkel

    const UsdAttribute* find(const std::string& attribute) const;
};

/// The defined prims of a text, parents before children.
struct UsdStage {
    std::vector<UsdPrim> prims;
    std::optional<double> metres_per_unit;
    std::optional<char> up;
    double time_codes_per_second = 24.0;

    std::string path(int prim) const;  ///< "/root/body"
};

/// Finds prims, and where the values of their attributes stand, in one pass. Throws InputError, one line that
/// begins with the path: for a binary file, another form, a layer with sub-layers, and time codes that are
/// not finite or stand there twice.
UsdStage read_usda_stage(const InputFile& file);

/// The Mesh named by `path`; by default the only one whose points have time samples, else the only one.
/// Throws InputError, which lists the meshes, where there is none or more than one; also for a mesh that
/// takes values from elsewhere (references, variants), itself or by a prim above it.
int find_usda_mesh(const InputFile& file, const UsdStage& stage, const std::optional<std::string>& path);

}  // namespace arris

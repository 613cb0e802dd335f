// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/mesh_forecast.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/scene/scene_load.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

using ::testing::Optional;
using ::testing::StrEq;

const std::string kOutline =
    "duration = 1\n[cloth]\noutline = [[0, 0], [1, 0], [1, 1], [0, 1]]\nedge_length = ";

std::optional<std::string> forecast(const std::string& text)
{
    return forecast_long_meshing({"s.toml", text, {}});
}

TEST(MeshForecast, CountsTheVerticesOfAMeshThatTakesLong)
{
    // A square of 500 x 500 edge lengths, of 1.2 vertices each.
    EXPECT_THAT(forecast(kOutline + "0.002\n"),
                Optional(StrEq("making a mesh of about 0.3 million vertices, by cloth.edge_length")));
    // A cell of the pattern "cross" has one vertex at its corners and one in its middle.
    EXPECT_THAT(forecast("duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [1000, 1000]\n"),
                Optional(StrEq("making a mesh of about 2 million vertices, by cloth.resolution")));
}

TEST(MeshForecast, IsSilentOfAMeshThatIsQuickOrNeverMade)
{
    EXPECT_EQ(forecast(kOutline + "0.01\n"), std::nullopt);
    EXPECT_EQ(forecast(kOutline + "1e-6\n"), std::nullopt) << "load_scene refuses it";
    EXPECT_EQ(forecast("duration = 1\n[cloth]\nfile = \"cloth.obj\"\n"), std::nullopt);
    EXPECT_THROW(forecast("duration = 1\n[cloth]\nsize = [1, 1]\n"), InputError);
}

}  // namespace
}  // namespace arris

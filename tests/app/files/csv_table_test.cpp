// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/files/csv_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "geometry/input_error.h"
#include "tests/app/error_of.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::HasSubstr;

StepRow make_row()
{
    StepRow row;
    row.step = 12;
    row.time = 0.1 + 0.2;
    row.dt = 5e-324;
    row.vertices = 961;
    row.faces = 1800;
    row.contacts = 3;
    row.kinetic_energy = 1e308;
    row.stretch_energy = -0.0;
    row.kkt_residual = 1.0 / 3.0 * 1e-12;
    row.seconds.move = 1e-9;
    row.seconds.output = 10.0;
    row.cpu_seconds = 0.25;
    row.is_halved = true;
    row.solves = 2;
    row.yielded = 4;
    return row;
}

TEST(CsvTable, HasTheColumnsOfStepsInTheirOrder)
{
    EXPECT_THAT(
        step_header(),
        ::testing::StartsWith(
            "step,time,dt,vertices,faces,eol_vertices,feature_rows,contacts,kinetic_energy,gravity_energy,"
            "stretch_energy,bending_energy,material_area,max_penetration,crossings,min_angle,kkt_residual,"
            "factorisations,nlopt_evaluations,move_s,contacts_s,conform_s,transfer_s,assemble_s,factorise_s,"
            "solve_s,check_s,advance_s,output_s"));
    EXPECT_THAT(step_header(),
                ::testing::EndsWith(
                    ",output_s,cpu_s,halved,solves,rewound,yielded,energy_rise,eol_pressing,"
                    "max_strain,friction_sweeps,friction_residual,friction_work,sticking,sliding,self_"
                    "contacts,remeshed,remesh_energy,sewing_energy,open_pairs,"
                    "rows_new,rows_not_crossing,rows_at_eol,rows_beside_eol,rows_flat_behind,rows_unresolved,"
                    "rows_near_border,rows_border_ahead,"
                    "rows_guard,rows_quality,rows_off_plane,rows_blocked,rows_gathering,"
                    "rows_given_up,rows_released,rows_no_direction,"
                    "rows_along_border,rows_edge_on,rows_cloth_corner,"
                    "rows_other_feature,rows_other_obstacle"));
}

TEST(CsvTable, HasSixColumnsForEachProbe)
{
    EXPECT_EQ(probe_header({}), "time");
    EXPECT_EQ(probe_header({"tip", "b"}),
              "time,tip_x,tip_y,tip_z,tip_vx,tip_vy,tip_vz,b_x,b_y,b_z,b_vx,b_vy,b_vz");
    EXPECT_EQ(format_row(0.5, {{{1.0, -0.0, 0.1}, {2.0, 3.0, 4.0}}}), "0.5,1,-0,0.1,2,3,4");
    EXPECT_EQ(format_row(0.5, {}), "0.5");
}

TEST(CsvTable, ReadsNumbersBackToTheSameDouble)
{
    const TemporaryDirectory dir;
    const StepRow row = make_row();
    CsvWriter::create(dir / "a.csv", step_header()).append(format_row(row));
    const CsvTable table = read_csv(dir / "a.csv");
    ASSERT_EQ(table.row_count(), 1U);
    const auto expect_bits = [&](const char* name, double value) {
        EXPECT_EQ(std::bit_cast<std::uint64_t>(table.column(name)[0]), std::bit_cast<std::uint64_t>(value))
            << name;
    };
    expect_bits("step", 12.0);
    expect_bits("time", row.time);
    expect_bits("dt", row.dt);
    expect_bits("kinetic_energy", row.kinetic_energy);
    expect_bits("stretch_energy", -0.0);
    expect_bits("kkt_residual", row.kkt_residual);
    expect_bits("move_s", 1e-9);
    expect_bits("output_s", 10.0);
    expect_bits("cpu_s", 0.25);
    expect_bits("halved", 1.0);
    expect_bits("solves", 2.0);
    expect_bits("yielded", 4.0);
}

TEST(CsvTable, LeavesTheCellOfAnAbsentEffectEmpty)
{
    const TemporaryDirectory dir;
    StepRow row = make_row();
    EXPECT_THAT(format_row(row), HasSubstr(",1800,,,3,1e+308,,-0,,"));
    CsvWriter::create(dir / "a.csv", step_header()).append(format_row(row));
    EXPECT_TRUE(std::isnan(read_csv(dir / "a.csv").column("gravity_energy")[0]));
}

TEST(CsvTable, KeepsEachRowAsSoonAsItIsAppended)
{
    const TemporaryDirectory dir;
    CsvWriter writer = CsvWriter::create(dir / "a.csv", "t,x");
    EXPECT_EQ(read_bytes(dir / "a.csv"), "t,x\n");
    writer.append("0,1");
    EXPECT_EQ(read_bytes(dir / "a.csv"), "t,x\n0,1\n");
}

TEST(CsvTable, ReadsPastATornLastLine)
{
    const TemporaryDirectory dir;
    for (const char* torn : {"2", "2,", "2,0.00", "2,3"}) {
        write_bytes(dir / "a.csv", std::string("t,x\n0,1\n1,2\n") + torn);
        EXPECT_EQ(read_csv(dir / "a.csv").column("x"), (std::vector<double>{1.0, 2.0})) << torn;
    }
    write_bytes(dir / "a.csv", "t,x\n");
    EXPECT_EQ(read_csv(dir / "a.csv").row_count(), 0U);
}

TEST(CsvTable, CutsBackToWholeRows)
{
    const TemporaryDirectory dir;
    for (const char* rest : {"", "2", "2,3\n", "2,3\n3,4\n4", "\n\n\n"}) {
        write_bytes(dir / "a.csv", std::string("t,x\n0,1\n1,2\n") + rest);
        truncate_csv(dir / "a.csv", 2);
        EXPECT_EQ(read_bytes(dir / "a.csv"), "t,x\n0,1\n1,2\n") << rest;
    }
    truncate_csv(dir / "a.csv", 0);
    EXPECT_EQ(read_bytes(dir / "a.csv"), "t,x\n");
}

TEST(CsvTable, RefusesToCutToMoreRowsThanThereAre)
{
    const TemporaryDirectory dir;
    write_bytes(dir / "a.csv", "t,x\n0,1\n1,2");
    EXPECT_THAT(error_of([&] { truncate_csv(dir / "a.csv", 2); }),
                HasSubstr("a.csv: has 1 complete rows, but"));
    write_bytes(dir / "a.csv", "t,x");
    EXPECT_THAT(error_of([&] { truncate_csv(dir / "a.csv", 0); }), HasSubstr("a.csv"));
    EXPECT_THAT(error_of([&] { truncate_csv(dir / "missing.csv", 0); }), HasSubstr("missing.csv"));
    EXPECT_EQ(read_bytes(dir / "a.csv"), "t,x");
}

TEST(CsvTable, GoesOnWhereItWasCut)
{
    const TemporaryDirectory dir;
    write_bytes(dir / "a.csv", "t,x\n0,1\n1,2\n2,");
    EXPECT_THAT(error_of([&] { CsvWriter::append_to(dir / "a.csv", "t,x"); }), HasSubstr("incomplete"));
    truncate_csv(dir / "a.csv", 1);
    CsvWriter::append_to(dir / "a.csv", "t,x").append("1,7");
    EXPECT_EQ(read_bytes(dir / "a.csv"), "t,x\n0,1\n1,7\n");
    EXPECT_THAT(error_of([&] { CsvWriter::append_to(dir / "a.csv", "t,y"); }), HasSubstr("columns"));
    EXPECT_THAT(error_of([&] { CsvWriter::append_to(dir / "missing.csv", "t,x"); }),
                HasSubstr("missing.csv"));
}

TEST(CsvTable, NamesFileAndLineOfWhatIsNotANumber)
{
    const TemporaryDirectory dir;
    const auto error_in = [&](const std::string& text) {
        write_bytes(dir / "a.csv", text);
        return error_of([&] { read_csv(dir / "a.csv"); });
    };
    EXPECT_THAT(error_in("t,x\n0,1\n1,two\n"), HasSubstr("a.csv: line 3"));
    EXPECT_THAT(error_in("t,x\n0,1 \n"), HasSubstr("line 2"));
    EXPECT_THAT(error_in("t,x\n0,1,2\n"), HasSubstr("has 3 cells, not 2"));
    EXPECT_THAT(error_in("t,x\n0\n"), HasSubstr("has 1 cells, not 2"));
    EXPECT_THAT(error_in(""), HasSubstr("no header"));
    EXPECT_THAT(error_of([&] { read_csv(dir / "missing.csv"); }), HasSubstr("missing.csv"));
}

TEST(CsvTable, NamesAMissingColumn)
{
    const TemporaryDirectory dir;
    write_bytes(dir / "a.csv", "t,x\n0,1\n");
    EXPECT_THAT(error_of([&] { read_csv(dir / "a.csv").column("y"); }),
                HasSubstr("a.csv: has no column \"y\""));
    EXPECT_FALSE(CsvReader(dir / "a.csv").has_column("y"));
}

}  // namespace
}  // namespace arris

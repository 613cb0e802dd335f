// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "app/files/csv_table.h"
#include "geometry/input_error.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using nlohmann::ordered_json;

StepRow make_row(std::int64_t step)
{
    StepRow row;
    row.step = step;
    row.time = 0.25 * static_cast<double>(step);
    row.kkt_residual = step == 2 ? 1e-11 : 1e-13;
    row.max_penetration = step == 1 ? 0.125 : 0.0;
    row.crossings = step >= 2 ? 3 : 0;
    row.is_halved = step == 3;
    row.cpu_seconds = 2.0;
    row.seconds = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
    return row;
}

std::string write_steps(const TemporaryDirectory& dir, std::int64_t last_step)
{
    CsvWriter writer = CsvWriter::create(dir / "steps.csv", step_header());
    for (std::int64_t step = 0; step <= last_step; ++step) writer.append(format_row(make_row(step)));
    return dir / "steps.csv";
}

TEST(Report, SumsWhatTheStepsSay)
{
    const TemporaryDirectory dir;
    const StepTotals totals = sum_steps(write_steps(dir, 4));
    EXPECT_EQ(totals.steps, 4);
    EXPECT_EQ(totals.simulated_seconds, 1.0);
    EXPECT_EQ(totals.wall_seconds, 5.0 * 55.0);  // the initial row too: its output took time
    EXPECT_EQ(totals.cpu_seconds, 10.0);
    EXPECT_EQ(totals.max_penetration, 0.125);
    EXPECT_EQ(totals.crossings, 3);
    EXPECT_EQ(totals.max_kkt_residual, 1e-11);
    EXPECT_EQ(totals.halved_steps, 1);
    const std::vector<NamedSeconds> phases = list_phases(totals.phases);
    ASSERT_EQ(phases.size(), 10U);
    for (std::size_t i = 0; i < phases.size(); ++i)
        EXPECT_EQ(phases[i].seconds, 5.0 * static_cast<double>(i + 1));
}

TEST(Report, CountsFeatureContactsByWhatTheyWere)
{
    const TemporaryDirectory dir;
    EXPECT_FALSE(sum_steps(write_steps(dir, 2)).features) << "no EOL vertices were wanted";

    // Of 90 that pressed twice and could have been EOL 88 were; what is new, what has no coordinates or no
    // room before the cloth's border, and what is an EOL vertex's own contact, does not count.
    StepRow row = make_row(3);
    row.eol_pressing = 80;
    row.rows_by_cause.emplace();
    const auto count = [&row](ConstraintCause cause, int rows) {
        (*row.rows_by_cause)[static_cast<std::size_t>(cause)] = rows;
    };
    count(ConstraintCause::New, 20);
    count(ConstraintCause::AlongBorder, 5);
    count(ConstraintCause::OtherObstacle, 3);
    count(ConstraintCause::NearBorder, 4);
    count(ConstraintCause::AtEol, 7);
    count(ConstraintCause::Guard, 1);
    count(ConstraintCause::OtherFeature, 1);
    const std::string path = write_steps(dir, 2);
    CsvWriter writer = CsvWriter::append_to(path, step_header());
    writer.append(format_row(row));
    row.rows_by_cause->fill(0);
    row.eol_pressing = 8;
    writer.append(format_row(row));
    RunReport report;
    report.totals = sum_steps(path);
    ASSERT_TRUE(report.totals.features);
    const nlohmann::ordered_json json = to_json(report)["feature_contacts"];
    EXPECT_EQ(json["eol"], 88);
    EXPECT_EQ(json["rows"].size(), kConstraintCauses);
    EXPECT_EQ(json["rows"]["new"], 20);
    EXPECT_EQ(json["rows"]["along_border"], 5);
    EXPECT_EQ(json["rows"]["other_obstacle"], 3);
    EXPECT_EQ(json["rows"]["other_feature"], 1);
    EXPECT_EQ(json["rows"]["at_eol"], 7);
    EXPECT_EQ(json["rows"]["near_border"], 4);
    EXPECT_EQ(json["rows"]["guard"], 1);
    EXPECT_EQ(json["rows"]["quality"], 0);
    EXPECT_DOUBLE_EQ(json["eol_share"].get<double>(), 88.0 / 90.0);

    report.totals.features = FeatureTotals();
    EXPECT_TRUE(to_json(report)["feature_contacts"]["eol_share"].is_null()) << "nothing pressed";
}

TEST(Report, NamesPhasesAsTheColumnsOfSteps)
{
    for (const NamedSeconds& phase : list_phases({}))
        EXPECT_THAT(step_header(), ::testing::HasSubstr("," + std::string(phase.name) + "_s,"));
}

TEST(Report, SumsARunWithoutStepsAndATornOne)
{
    const TemporaryDirectory dir;
    EXPECT_EQ(sum_steps(write_steps(dir, 0)).steps, 0);
    write_bytes(dir / "steps.csv", step_header() + "\n");
    EXPECT_EQ(sum_steps(dir / "steps.csv").wall_seconds, 0.0);
    write_steps(dir, 2);
    write_bytes(dir / "steps.csv", read_bytes(dir / "steps.csv") + "3,0.75,0.2");
    EXPECT_EQ(sum_steps(dir / "steps.csv").steps, 2);
}

TEST(Report, DoesNotLoseAResidualThatIsNotANumber)
{
    const TemporaryDirectory dir;
    CsvWriter writer = CsvWriter::create(dir / "steps.csv", step_header());
    StepRow row = make_row(1);
    row.kkt_residual = std::nan("");
    writer.append(format_row(row));
    EXPECT_TRUE(std::isnan(sum_steps(dir / "steps.csv").max_kkt_residual));
}

TEST(Report, RefusesATableThatIsNotOfSteps)
{
    const TemporaryDirectory dir;
    write_bytes(dir / "a.csv", "t,x\n0,1\n");
    EXPECT_THROW(sum_steps(dir / "a.csv"), InputError);
    std::string row = format_row(make_row(1));
    write_bytes(dir / "a.csv", step_header() + "\n" + row.substr(row.find(',')) + "\n");  // no step number
    EXPECT_THROW(sum_steps(dir / "a.csv"), InputError);
}

TEST(Report, WritesEveryFieldOfTheContract)
{
    const TemporaryDirectory dir;
    RunReport report;
    report.status = RunStatus::NotConverged;
    report.message = "why";
    report.totals = sum_steps(write_steps(dir, 4));
    report.peak_memory_bytes = 1LL << 40;
    report.effects = {{"gravity", true, ""}, {"wind", false, ""}, {"obstacle", true, ""}};
    report.warnings = {"a warning"};
    report.scene = {{"title", "T"}, {"time", {{"step", 0.1}}}};
    report.version = "0.1.0";
    report.threads = 2;
    report.kernel = "Haswell";
    report.processor = "a processor";
    write_report_json(dir / "report.json", report);

    const ordered_json json = ordered_json::parse(read_bytes(dir / "report.json"));
    EXPECT_EQ(json["status"], "not_converged");
    EXPECT_EQ(json["message"], "why");
    EXPECT_EQ(json["steps"], 4);
    EXPECT_EQ(json["simulated_seconds"], 1.0);
    EXPECT_EQ(json["wall_seconds"], 275.0);
    EXPECT_EQ(json["cpu_seconds"], 10.0);
    EXPECT_EQ(json["peak_memory_bytes"], 1LL << 40);
    EXPECT_EQ(json["max_penetration"], 0.125);
    EXPECT_EQ(json["crossings"], 3);
    EXPECT_EQ(json["max_kkt_residual"], 1e-11);
    EXPECT_EQ(json["halved_steps"], 1);
    EXPECT_EQ(json["effects"], (ordered_json{"gravity", "obstacle"}));
    EXPECT_EQ(json["phases"]["solve"], 35.0);
    EXPECT_EQ(json["phases"].size(), 10U);
    EXPECT_EQ(json["warnings"], ordered_json::array({"a warning"}));
    EXPECT_EQ(json["scene"], report.scene);
    EXPECT_EQ(json["version"], "0.1.0");
    EXPECT_EQ(json["threads"], 2);
    EXPECT_EQ(json["blas_kernel"], "Haswell");
    EXPECT_EQ(json["processor"], "a processor");
    EXPECT_EQ(json.size(), 19U);
}

TEST(Report, WritesEmptyListsAsLists)
{
    const ordered_json json = to_json(RunReport{});
    EXPECT_TRUE(json["effects"].is_array());
    EXPECT_TRUE(json["warnings"].is_array());
    EXPECT_TRUE(json["scene"].is_object());
    EXPECT_EQ(json["status"], "finished");
}

TEST(Report, NamesEveryStatus)
{
    using enum RunStatus;
    const std::vector<std::pair<RunStatus, std::string>> names = {
        {Finished, "finished"},       {Interrupted, "interrupted"},
        {Infeasible, "infeasible"},   {NotConverged, "not_converged"},
        {Penetration, "penetration"}, {NotFinite, "not_finite"},
        {IoError, "io_error"}};
    for (const auto& [status, name] : names) EXPECT_EQ(to_string(status), name);
}

TEST(Report, SurvivesTextThatIsNotUtf8)
{
    const TemporaryDirectory dir;
    RunReport report;
    report.message = "cannot write out/\xff\xfe.ply";
    write_report_json(dir / "report.json", report);
    EXPECT_THAT(ordered_json::parse(read_bytes(dir / "report.json"))["message"].get<std::string>(),
                ::testing::StartsWith("cannot write out/"));
}

TEST(Report, MeasuresThisProcess)
{
    EXPECT_GT(peak_memory_bytes(), 1 << 20);
    const double before = process_cpu_seconds();
    volatile double sink = 0.0;
    for (int i = 0; i < 10000000; ++i) sink = sink + 1.0;
    EXPECT_GT(process_cpu_seconds(), before);
}

TEST(Report, DocsNameEveryColumnOfStepsAndEveryKeyOfTheReport)
{
    const std::string text = read_bytes(std::string(ARRIS_SOURCE_DIR) + "/docs/output.md");
    const auto is_named = [&](const std::string& name) {
        return text.find("`" + name + "`") != std::string::npos;
    };
    std::istringstream columns(step_header());
    for (std::string column; std::getline(columns, column, ',');) EXPECT_TRUE(is_named(column)) << column;

    RunReport report;
    report.totals.features.emplace();
    const ordered_json json = to_json(report);
    for (const auto& [key, value] : json.items()) EXPECT_TRUE(is_named(key)) << key;
    for (const auto& [key, value] : json["feature_contacts"].items()) EXPECT_TRUE(is_named(key)) << key;
}

}  // namespace
}  // namespace arris

// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report/report_html.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

#include "app/files/csv_table.h"
#include "app/files/frame_files.h"
#include "app/report/report_features.h"
#include "app/report/report_plots.h"
#include "embedded/report_template.h"
#include "geometry/input_error.h"
#include "tests/app/example_frame.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kEvil = "</script><img src=x onerror=alert(1)>\"'&{{scene}}";

void write_steps(const TemporaryDirectory& dir, int last_step, void (*change)(StepRow&) = nullptr)
{
    CsvWriter writer = CsvWriter::create(dir / "steps.csv", step_header());
    for (int step = 0; step <= last_step; ++step) {
        StepRow row;
        row.step = step;
        row.time = 0.01 * step;
        row.dt = step > 0 ? 0.01 : 0.0;
        row.vertices = 100;
        row.faces = 180;
        row.kinetic_energy = 0.1 * step;
        row.min_angle = 45.0;
        row.kkt_residual = step > 0 ? 1e-13 : 0.0;
        row.seconds.solve = 0.002;
        if (change) change(row);
        writer.append(format_row(row));
    }
}

void write_probes(const TemporaryDirectory& dir, const std::vector<std::string>& names)
{
    CsvWriter writer = CsvWriter::create(dir / "probes.csv", probe_header(names));
    for (int i = 0; i < 3; ++i) writer.append(format_row(0.1 * i, std::vector<ProbeSample>(names.size())));
}

std::string html_of(const TemporaryDirectory& dir, RunReport report = {})
{
    report.totals = sum_steps(dir / "steps.csv");
    write_report_html(dir.path(), report);
    return read_bytes(dir / "report.html");
}

/// Checks that elements are closed in the order they were opened, and returns the names of all.
std::set<std::string> elements_of(const std::string& html)
{
    static const std::set<std::string> kVoid = {"meta", "path", "br", "img"};
    std::set<std::string> names;
    std::vector<std::string> open;
    for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
        if (html.compare(at, 2, "<!") == 0) continue;
        const bool is_closing = html[at + 1] == '/';
        const std::size_t begin = at + (is_closing ? 2 : 1);
        const std::string name = html.substr(begin, html.find_first_of(" />\n", begin) - begin);
        names.insert(name);
        if (is_closing && (open.empty() || open.back() != name))
            throw std::runtime_error("unmatched </" + name);
        if (is_closing)
            open.pop_back();
        else if (!kVoid.contains(name))
            open.push_back(name);
    }
    if (!open.empty()) throw std::runtime_error("unclosed <" + open.back());
    return names;
}

std::size_t count(const std::string& text, const std::string& part)
{
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}

TEST(ReportHtml, IsOnePageWithoutScriptsOrNetwork)
{
    const TemporaryDirectory dir;
    write_steps(dir, 20);
    write_probes(dir, {"tip"});
    const std::string html = html_of(dir);
    const std::set<std::string> elements = elements_of(html);
    for (const char* name : {"script", "link", "img", "iframe", "object", "a"})
        EXPECT_FALSE(elements.contains(name)) << name;
    EXPECT_THAT(html, AllOf(Not(HasSubstr("http:")), Not(HasSubstr("https:")), Not(HasSubstr("@import")),
                            Not(HasSubstr("url("))));
    EXPECT_THAT(html, AllOf(HasSubstr("SPDX-License-Identifier: MIT"), Not(HasSubstr("{{"))));
}

TEST(ReportHtml, TakesEveryNameAndMessageForText)
{
    const TemporaryDirectory dir;
    write_steps(dir, 3);
    write_probes(dir, {"p</script><img src=x onerror=alert(1)>"});
    RunReport report;
    report.status = RunStatus::Infeasible;
    report.message = report.version = kEvil;
    report.warnings = {kEvil};
    report.effects = {{kEvil, true, kEvil}, {kEvil, false, kEvil}};
    report.scene = {{"title", kEvil}, {kEvil, kEvil}, {"obstacle", {{{"name", kEvil}}}}};
    const std::string html = html_of(dir, report);
    const std::set<std::string> elements = elements_of(html);
    EXPECT_FALSE(elements.contains("img"));
    EXPECT_FALSE(elements.contains("script"));
    // Title twice, message, version, warning, two effects with reasons; in the scene title, a key, its value,
    // the name.
    EXPECT_EQ(count(html, "&lt;/script&gt;&lt;img src=x onerror=alert(1)&gt;&quot;&#39;&amp;{{scene}}"), 13U);
}

TEST(ReportHtml, ShowsWhatTheReportSays)
{
    const TemporaryDirectory dir;
    write_steps(dir, 20, [](StepRow& row) { row.is_halved = row.step == 7; });
    RunReport report;
    report.status = RunStatus::NotConverged;
    report.message = "step 20 did not converge";
    report.threads = 4;
    report.peak_memory_bytes = 512LL << 20;
    report.scene = {
        {"title", "Tablecloth"}, {"cloth", {{"size", {1.0, 2.5}}}}, {"obstacle", {{{"name", "t"}}}}};
    const std::string html = html_of(dir, report);
    for (const char* part :
         {"<h1>Tablecloth</h1>", "not converged", "step 20 did not converge", "4 threads", "512.0 MiB",
          "1 of them halved", "<dd>20<", "0.2 s", "cloth.size", "[1.0,2.5]", "obstacle.0.name"})
        EXPECT_THAT(html, HasSubstr(part));
}

TEST(ReportHtml, BeginsWithTheVerdictThePictureAndTheViewer)
{
    const TemporaryDirectory dir;
    write_steps(dir, 20);
    std::filesystem::create_directories(dir / "frames");
    write_frame(frame_file(dir.path(), 0, "ply"), make_example_frame());
    write_frame(frame_file(dir.path(), 1, "ply"), make_example_frame());
    RunReport report;
    report.scene = {{"output", {{"frames_per_second", 4.0}}}};
    const std::string without = html_of(dir, report);
    EXPECT_THAT(without, Not(HasSubstr("<a ")));
    write_bytes(dir / "viewer.html", "");
    const std::string html = html_of(dir, report);
    EXPECT_NO_THROW(elements_of(html));
    std::size_t last = 0;
    for (const char* part : {"<h1>", "class=\"verdict good\">Finished.", "<img ", "The last frame, at 0.25 s",
                             "<a href=\"viewer.html\">", "<h2>Effects", "<h2>Figures", "<h2>Over time"}) {
        const std::size_t at = html.find(part);
        ASSERT_NE(at, std::string::npos) << part;
        EXPECT_GT(at, last) << part;
        last = at;
    }
}

TEST(ReportHtml, IsWrittenWithoutAPictureWhereAFrameIsDamaged)
{
    const TemporaryDirectory dir;
    write_steps(dir, 20);
    std::filesystem::create_directories(dir / "frames");
    write_bytes(frame_file(dir.path(), 0, "ply"), "ply\n");
    const std::string html = html_of(dir);
    EXPECT_THAT(html, AllOf(HasSubstr("There is no picture: "), HasSubstr("cloth_00000.ply"),
                            Not(HasSubstr("<img"))));
}

TEST(ReportHtml, IsBadInColourWhereSomethingPassedThrough)
{
    const TemporaryDirectory dir;
    write_steps(dir, 3, [](StepRow& row) { row.crossings = row.step == 3; });
    EXPECT_THAT(html_of(dir), HasSubstr("class=\"verdict bad\">Finished. Something passed"));
}

TEST(ReportHtml, TellsWhyEachEffectIsOnOrOff)
{
    const TemporaryDirectory dir;
    write_steps(dir, 3);
    RunReport report;
    report.effects = {{"wind", false, "no [wind]"}, {"gravity", true, "[gravity] is given"}};
    const std::string html = html_of(dir, report);
    const std::size_t on = html.find("<th scope=\"row\">gravity</th><td>on</td><td>[gravity] is given</td>");
    const std::size_t off = html.find("<th scope=\"row\">wind</th><td>off</td><td>no [wind]</td>");
    ASSERT_NE(on, std::string::npos);
    ASSERT_NE(off, std::string::npos);
    EXPECT_LT(on, off);
}

TEST(ReportHtml, TellsTheShareOfEolVerticesAndWhyRowsAreRows)
{
    const TemporaryDirectory dir;
    write_steps(dir, 4, [](StepRow& row) {
        row.eol_vertices = row.eol_pressing = 9;
        row.rows_by_cause.emplace().fill(0);
        (*row.rows_by_cause)[static_cast<std::size_t>(ConstraintCause::Guard)] = 1;
        (*row.rows_by_cause)[static_cast<std::size_t>(ConstraintCause::NearBorder)] = 3;
    });
    const std::string html = html_of(dir);
    EXPECT_NO_THROW(elements_of(html));
    for (const std::string& part :
         {std::string("<dt>EOL share</dt><dd>90 %"), std::string("Contacts on sharp features"),
          std::string("<th scope=\"row\">EOL vertex</th><td class=\"count\">45</td>"),
          std::string("row: guard</th><td class=\"count\">5</td><td>") + explain(ConstraintCause::Guard) +
              "</td>",
          std::string("row: near_border</th><td class=\"count\">15</td><td>") +
              explain(ConstraintCause::NearBorder) + " (not counted in the EOL share)</td>"})
        EXPECT_THAT(html, HasSubstr(part));
    EXPECT_THAT(html, Not(HasSubstr("row: blocked"))) << "what did not happen says nothing";

    write_steps(dir, 4);
    const std::string without = html_of(dir);
    EXPECT_THAT(without, AllOf(Not(HasSubstr("EOL share")), Not(HasSubstr("Contacts on sharp features"))));
}

TEST(ReportHtml, ExplainsEveryFigureItShows)
{
    for (std::size_t k = 0; k < kConstraintCauses; ++k)
        EXPECT_GT(std::string(explain(static_cast<ConstraintCause>(k))).size(), 15U) << k;
    for (const NamedSeconds& phase : list_phases({}))
        EXPECT_GT(std::string(phase.what).size(), 10U) << phase.name;
    const TemporaryDirectory dir;
    write_steps(dir, 20, [](StepRow& row) {
        row.max_penetration = row.min_angle = static_cast<double>(row.step);
        row.crossings = row.vertices = row.contacts = row.step;
        row.gravity_energy = 1.0;
    });
    for (const Plot& plot : plot_steps(dir / "steps.csv", 1e-9))
        EXPECT_GT(plot.note.size(), 10U) << plot.title;
    RunReport report;
    report.effects = {{"obstacle", true, "1 [[obstacle]]: table"}};
    const std::string html = html_of(dir, report);
    EXPECT_EQ(count(html, "<div class=\"fact"), count(html, "<dd class=\"why\">"));
    EXPECT_EQ(count(html, "<dd class=\"why\"></dd>"), 0U);
}

TEST(ReportHtml, CountsCrossingsWhereTheClothMeetsAnythingAndNamesWhat)
{
    const TemporaryDirectory dir;
    write_steps(dir, 20);
    const auto crossings_of = [&](bool has_obstacles, bool has_layers) {
        RunReport report;
        report.effects = {{"obstacle", has_obstacles, ""}, {"self_contact", has_layers, ""}};
        const std::string html = html_of(dir, report);
        const std::size_t at = html.find("<dt>Crossings</dt>");
        return at == std::string::npos ? "" : html.substr(at, html.find("</div>", at) - at);
    };
    EXPECT_EQ(crossings_of(false, false), "");
    EXPECT_THAT(crossings_of(true, false), HasSubstr("passed through an obstacle; must be 0"));
    EXPECT_THAT(crossings_of(false, true), HasSubstr("passed through itself; must be 0"));
    EXPECT_THAT(crossings_of(true, true), HasSubstr("passed through an obstacle or itself; must be 0"));
}

TEST(ReportHtml, ShowsRunsWithoutStepsFramesOrRows)
{
    const TemporaryDirectory dir;
    write_steps(dir, 0);
    EXPECT_NO_THROW(elements_of(html_of(dir)));
    write_bytes(dir / "steps.csv", step_header() + "\n");
    const std::string html = html_of(dir);
    EXPECT_NO_THROW(elements_of(html));
    EXPECT_THAT(html,
                AllOf(HasSubstr("nothing to show"), HasSubstr("Untitled scene"), Not(HasSubstr("nan"))));
}

TEST(ReportHtml, ShowsOnlyPlotsWithSomethingToSay)
{
    const TemporaryDirectory dir;
    write_steps(dir, 20);
    const std::string quiet = html_of(dir);
    for (const char* title : {">Penetration<", ">Crossings so far<", ">Mesh<", ">Least angle of the mesh<",
                              ">Kinetic and elastic energy<", "gravity", "EOL vertices"})
        EXPECT_THAT(quiet, Not(HasSubstr(title)));
    write_steps(dir, 20, [](StepRow& row) {
        row.max_penetration = row.step == 5 ? 1e-5 : 0.0;
        row.crossings = row.step >= 5;
        row.vertices += row.step / 10;
        row.min_angle -= static_cast<double>(row.step);
        row.gravity_energy = 1.0;
        row.eol_vertices = 2;
    });
    const std::string eventful = html_of(dir);
    for (const char* title : {">Penetration<", ">Crossings so far<", ">Mesh<", ">Least angle of the mesh<",
                              ">Kinetic and elastic energy<", "gravity", "EOL vertices"})
        EXPECT_THAT(eventful, HasSubstr(title));
}

TEST(ReportHtml, HasOnlyLinesOfOneScaleInAPlotOfWork)
{
    const TemporaryDirectory dir;
    write_steps(dir, 20, [](StepRow& row) {
        row.factorisations = 2;
        row.nlopt_evaluations = 900;
    });
    int found = 0;
    for (const Plot& plot : plot_steps(dir / "steps.csv", std::nullopt))
        for (const PlotLine& line : plot.lines)
            if (line.name == "factorisations" || line.name == "NLopt evaluations") {
                EXPECT_EQ(plot.lines.size(), 1U) << plot.title;
                ++found;
            }
    EXPECT_EQ(found, 2);
}

TEST(ReportHtml, StaysSmallForALongRunAndKeepsItsPeaks)
{
    const TemporaryDirectory dir;
    write_steps(dir, 30000, [](StepRow& row) {
        row.kinetic_energy = row.step == 12345 ? 7777.0 : 1.0;  // a single step out of 30000
        row.seconds.solve = 0.001 * static_cast<double>(1 + row.step % 17);
    });
    const std::string html = html_of(dir);
    EXPECT_LT(html.size(), 600000U);
    EXPECT_THAT(html, HasSubstr(">8000<"));  // the axis reaches up to the peak
}

TEST(ReportHtml, LimitsTheNumberOfProbePlotsAndSaysSo)
{
    const TemporaryDirectory dir;
    write_steps(dir, 3);
    std::vector<std::string> names;
    for (int i = 0; i < 30; ++i) names.push_back("probe_x" + std::to_string(i));
    write_probes(dir, names);
    const std::string html = html_of(dir);
    EXPECT_EQ(count(html, ">Probe probe_x"), 24U);
    EXPECT_THAT(html, HasSubstr("6 more probes are in probes.csv"));
}

TEST(ReportHtml, LeavesTheOldPageWhereATableIsBad)
{
    const TemporaryDirectory dir;
    write_steps(dir, 3);
    const std::string good = html_of(dir);
    write_bytes(dir / "probes.csv", "time,a_x,a_y,a_z,a_vx,a_vy,a_vz\n0,1\n");
    EXPECT_THROW(write_report_html(dir.path(), {}), InputError);
    EXPECT_EQ(read_bytes(dir / "report.html"), good);
    std::filesystem::remove(dir / "steps.csv");
    EXPECT_THROW(write_report_html(dir.path(), {}), InputError);
}

TEST(Embed, HoldsTheFileByteForByte)
{
    EXPECT_EQ(embedded::report_template(),
              read_bytes(std::string(ARRIS_SOURCE_DIR) + "/app/report/report_template.html"));
}

}  // namespace
}  // namespace arris

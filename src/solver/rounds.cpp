// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/rounds.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "solver/contact/constraints.h"
#include "solver/energy_balance.h"
#include "solver/failure_place.h"
#include "solver/infeasible.h"
#include "solver/material_flow.h"
#include "solver/model/eol_limits.h"
#include "solver/model/stopwatch.h"
#include "solver/next.h"
#include "solver/not_finite.h"
#include "solver/overconstrained.h"
#include "solver/relinearization.h"
#include "solver/step_contacts.h"
#include "solver/step_friction.h"

namespace arris {

namespace {

/// Velocity solves of one attempt. Returning to the linearization with the least energy rise may add one
/// more.
constexpr int kMostSolves = 12;

/// Work of one attempt at a step in all its velocity solves, in factorisations' worth. Beyond it the attempt
/// fails, and the next one is shorter. The last one may do more, as the run may end where it fails: cloth
/// that friction locks in a crease needs 100.
constexpr double kMostWorkOfAttempt = 60.0, kMostWorkOfLast = RetryPolicy::kMostWork;

/// One attempt's rounds.
struct Rounds {
    const Scene& scene;
    const Settings& settings;
    double end;  ///< s
    const State& state;
    Attempt attempt;
    Workspace& work;
    StepReport& report;
    Violations violations = {};         ///< of the last proposal
    std::vector<Overrun> overrun = {};  ///< of the last linearisation or proposal

    double dt() const { return end - state.time; }
    bool may_solve_again() const { return report.solves < kMostSolves; }
};

/// Stage 4: gives each vertex coordinates in which pins are known and contacts are bounds or rows. Assembles
/// A and b in these coordinates. False where a step would take more material from a face than the mesh
/// allows.
bool assemble(Rounds& round)
{
    const State& state = round.state;
    Workspace& work = round.work;
    build_constraints(work.pin_targets, work.eol, work.prediction, state, work.contacts, work.linearization,
                      work.problem);
    make_room_for_layers(work);
    work.slip_contacts = add_friction_pairs(slipping_cloth(round.scene, state, work), work.problem);
    Linearization& at = work.linearization;
    const Prediction& prediction = work.prediction;
    at.begin = state.time;
    at.time = round.end;
    at.gamma = prediction.gamma;
    at.damping.clear();
    for (const Material& material : round.scene.materials) at.damping.push_back(material.damping);
    at.v_predicted = prediction.velocity;
    at.v_last = state.velocity;
    round.overrun.clear();
    if (at.flow) {
        LinearisedFlow found =
            linearise_flow(state, prediction, std::move(work.expansion), work.eol, work.mesh, round.dt());
        work.expansion = std::move(found.expansion);
        round.overrun = std::move(found.overrun);
        if (!round.overrun.empty()) return false;
        at.flow->position = std::move(found.position);
        at.flow->extrapolated = std::move(found.extrapolated);
        at.flow->v_predicted = prediction.material_velocity;
        at.flow->v_expansion = work.expansion.material;
        at.flow->v_last = state.material_velocity;
    }
    at.v_expansion = work.expansion.world;
    at.position = find_end(prediction, work.expansion).world;
    work.mesh.system.assemble(state.mesh, work.mesh.elements, work.mesh.terms, at);
    return true;
}

/// Stage 5: minimises 1/2 u^T A u - b^T u under bounds and rows. Where only rows were added, the solve
/// resumes on the existing factorisation. Friction's budgets move within the solve until they agree.
void solve_velocity(const Rounds& round, bool does_resume)
{
    Workspace& work = round.work;
    StepReport& report = round.report;
    work.problem.matrix = &work.mesh.system.matrix();
    work.problem.rhs = &work.mesh.system.rhs();
    // Contacts of the cloth with itself couple what is far away in the material.
    const bool has_places = work.mesh.system.coupled().empty() && !work.mesh.elimination_places.empty();
    work.problem.places = has_places ? &work.mesh.elimination_places : nullptr;
    work.problem.most_work =
        (round.attempt == Attempt::Last ? kMostWorkOfLast : kMostWorkOfAttempt) - report.solve_work;
    work.problem.is_repeat = report.solves > 0;
    if (!work.problem.friction.empty()) set_friction_law(round.scene, round.state, work);
    work.solution = does_resume ? work.solver.resume(work.problem, round.settings)
                                : work.solver.solve(work.problem, round.settings);
    report.solve_work += work.solution.work;
    report.factorisations += work.solution.factorisations;
    report.nlopt_evaluations += work.solution.nlopt_evaluations;
    report.seconds.factorise += work.solution.factorise_seconds;
    report.seconds.solve += work.solution.solve_seconds;
    if (!work.problem.friction.empty()) note_friction(round.state, work, report);
    ++report.solves;
    report.kkt_residual = work.solution.kkt_residual;  // of the last solve, whose velocity is used
}

/// Proposes the material at the end. False where a face would have too little of it.
bool propose_flow(Rounds& round)
{
    Workspace& work = round.work;
    FlowedMaterial flowed = find_flowed_material(work.prediction, work.eol, work.solution.velocity);
    work.proposal.material = std::move(flowed.material);
    work.proposal.material_velocity = std::move(flowed.velocity);
    round.overrun = find_overrun(work.proposal.material, work.eol, work.mesh, round.dt());
    return round.overrun.empty();
}

/// Stage 6, first half: q' = q~ + gamma v'. Cloth nearer to an obstacle than its stand-off moves out by up to
/// `growth` (m), in position only.
void propose(double growth, Workspace& work)
{
    const std::size_t n = work.prediction.position.size();
    work.proposal.world.resize(n);
    work.proposal.velocity.resize(n);
    for (std::size_t v = 0; v < n; ++v) {
        Vec3& velocity = work.proposal.velocity[v];
        velocity = work.linearization.drift[v] +
                   work.linearization.basis[v] * work.solution.velocity.segment<3>(3 * v);
        work.proposal.world[v] = work.prediction.position[v] + work.prediction.gamma * velocity;
    }
    restore_stand_off(work.contacts, work.carriers, work.mobility, growth, work.proposal.world);
    hold_in_place(work.pin_targets, work.proposal.world);
}

/// Stage 6: makes the proposal and checks its whole path. Only the first solve pushes cloth out to its
/// stand-off, and not where the push would strain stiff cloth, or where the pushed proposal is not clean.
/// False where a number of the proposal is not finite.
bool propose_and_check(Rounds& round)
{
    Workspace& work = round.work;
    double growth = round.report.solves == 1 ? kMendingSpeed * round.dt() : 0.0;
    const auto propose_measured = [&](double by) {
        propose(by, work);
        measure_proposal_energy(round.scene, round.dt(), work);
    };
    const auto check = [&] {
        round.violations = check_proposal(round.scene, round.state, work.mesh.self_surface, work.proposal,
                                          work.prediction, work.carriers);
        const std::vector<Contact> floors =
            find_floors(work.carriers, work.prediction, work.contacts, work.proposal.world);
        round.violations.contacts.insert(round.violations.contacts.end(), floors.begin(), floors.end());
        round.report.crossings = round.violations.crossings;
    };
    propose_measured(growth);
    if (note_not_finite(CheckedStage::Proposal, round.state, work, round.report)) return false;
    if (growth > 0.0 && does_push_out_strain(round.scene, round.dt(), work)) propose_measured(growth = 0.0);
    check();
    if (round.violations.is_clean() || growth <= 0.0) return true;
    propose_measured(0.0);
    check();
    return true;
}

/// How a round ends.
enum class RoundEnd {
    Starved,
    Unsolved,
    NotFinite,
    Unmet,
    FoldPlanePresses,
    Overrun,
    Violated,
    Overconstrained,
    Clean
};

/// Stages 4 to 6 once.
RoundEnd run_round(Next from, Rounds& round)
{
    Workspace& work = round.work;
    StepReport& report = round.report;
    round.settings.stop_if_interrupted();
    Stopwatch watch;
    if (from == Next::Assemble && !assemble(round)) return RoundEnd::Starved;
    report.seconds.assemble += watch.lap();
    solve_velocity(round, from == Next::Resume);
    switch (work.solution.status) {
        case SolveStatus::NotConverged:
            return RoundEnd::Unsolved;
        case SolveStatus::NotFinite:
            note_not_finite(CheckedStage::Solve, round.state, work, report);
            return RoundEnd::NotFinite;
        case SolveStatus::Infeasible:
            return RoundEnd::Unmet;
        case SolveStatus::Certified:
            break;
    }
    if (report.friction_residual > kOffLaw && round.attempt == Attempt::Ordinary) return RoundEnd::Unsolved;
    if (round.may_solve_again() && drop_overconstraining_fold_planes(work)) return RoundEnd::FoldPlanePresses;
    watch.lap();
    if (!propose_flow(round)) return RoundEnd::Overrun;
    const bool is_finite = propose_and_check(round);
    report.seconds.check += watch.lap();
    if (!is_finite) return RoundEnd::NotFinite;
    if (!round.violations.is_clean()) return RoundEnd::Violated;
    return find_overconstrained_by_work(work).empty() ? RoundEnd::Clean : RoundEnd::Overconstrained;
}

template <StepStatus status>
Next fail(Rounds& round)
{
    round.report.status = status;
    return Next::Fail;
}

/// Ends rounds without a clean proposal: solves have run out, or no row could remove the violations. Only the
/// last attempt moves cloth back on its path (`rewind`), if its velocity is certified.
Next give_up(Rounds& round)
{
    Workspace& work = round.work;
    StepReport& report = round.report;
    std::vector<int> unmet = list_too_thin(work.carriers, work.contacts, work.proposal.world);
    unmet.insert(unmet.end(), work.solution.infeasible_rows.begin(), work.solution.infeasible_rows.end());
    if (work.solution.status == SolveStatus::Infeasible || !unmet.empty()) {
        report.status = StepStatus::Infeasible;
        report.infeasible = name_infeasible(round.state, {work.contacts, work.pin_targets, unmet});
    } else {
        report.status = StepStatus::Penetration;
    }
    if (round.attempt == Attempt::Ordinary || !(report.kkt_residual <= round.settings.tolerance))
        return Next::Fail;
    const std::optional<int> rewound =
        rewind(round.scene, round.state, work.mesh.self_surface, work.pin_targets, work.prediction,
               round.dt(), work.carriers, work.proposal);
    if (!rewound || !list_too_thin(work.carriers, work.contacts, work.proposal.world).empty())
        return Next::Fail;
    report.rewound = *rewound;
    report.crossings = 0;
    return Next::Accept;
}

Next squeeze_or_give_up(Rounds& round)
{
    if (round.may_solve_again() && squeeze_unmet(round.work)) return Next::Assemble;
    if (!propose_flow(round)) return fail<StepStatus::Overrun>(round);
    return propose_and_check(round) ? give_up(round) : Next::Fail;
}

Next add_rows_or_give_up(Rounds& round)
{
    const std::optional<Next> next =
        round.may_solve_again() ? add_violations(round.scene, round.state, round.violations, round.work)
                                : std::nullopt;
    return next ? *next : give_up(round);
}

Next solve_again(Rounds&)
{
    return Next::Assemble;
}

Next linearise_nearer_or_fail(Rounds& round)
{
    round.report.status = StepStatus::Overrun;
    if (!round.may_solve_again()) return Next::Fail;
    propose(0.0, round.work);
    return linearise_nearer(round.dt(), round.work, round.report) ? Next::Assemble : Next::Fail;
}

Next balance_energy(Rounds& round)
{
    return enforce_energy_balance(round.scene, round.state, round.attempt, round.may_solve_again(),
                                  round.work, round.report);
}

struct Rule {
    RoundEnd end;
    Next (*follow)(Rounds&);
    RoundRule in_words;
};

static_assert(kMostSolves == 12 && kMostWorkOfAttempt == 60.0 && kMostWorkOfLast == 400.0,
              "the words below say so");
constexpr Rule kRules[] = {
    {RoundEnd::Starved,
     fail<StepStatus::Overrun>,
     {"forces cannot be linearised: a face would lose too much material", "the attempt fails (overrun)", ""}},
    {RoundEnd::Unsolved,
     fail<StepStatus::NotConverged>,
     {"the solve has no certificate, or friction is off its law", "the attempt fails (not converged)",
      "60 factorisations' worth of work an attempt, 400 in the last one"}},
    {RoundEnd::NotFinite,
     fail<StepStatus::NotFinite>,
     {"a number is not finite", "the attempt fails, and names it", ""}},
    {RoundEnd::Unmet,
     squeeze_or_give_up,
     {"contacts cannot be met together",
      "the cloth is squeezed there, and a new system is solved; where it is already, the attempt fails "
      "(infeasible), or the last one moves cloth back on its path",
      "12 solves"}},
    {RoundEnd::FoldPlanePresses,
     solve_again,
     {"a plane behind a wire presses cloth on another obstacle", "the plane keeps nothing in this step",
      "12 solves"}},
    {RoundEnd::Overrun,
     linearise_nearer_or_fail,
     {"the flow would take too much material",
      "forces are linearised nearer to the last expansion; where less than a tenth of the way is left, the "
      "attempt fails (overrun)",
      "12 solves, 4 linearisations"}},
    {RoundEnd::Violated,
     add_rows_or_give_up,
     {"the check of the path finds contacts, or cloth squeezed below its least thickness",
      "they become rows of the same system, or of a new one where history changes or the cloth is squeezed; "
      "without any the attempt fails (penetration), or the last one moves cloth back on its path",
      "12 solves"}},
    {RoundEnd::Overconstrained,
     fail<StepStatus::Infeasible>,
     {"an EOL vertex is pressed from both sides", "the attempt fails (infeasible), and gives that vertex up",
      ""}},
    {RoundEnd::Clean,
     balance_energy,
     {"the path is free",
      "the step is accepted if the energy agrees with the work done; else forces are linearised again at the "
      "velocity found, and at last at the one with the least rise",
      "12 solves, 4 linearisations; then the attempt fails (energy rise), but not the last one"}},
};

}  // namespace

std::vector<Overrun> run_rounds(const Scene& scene, const Settings& settings, double end, const State& state,
                                Attempt attempt, Workspace& work, StepReport& report)
{
    Rounds round = {scene, settings, end, state, attempt, work, report};
    for (Next next = Next::Assemble; next == Next::Assemble || next == Next::Resume;) {
        const RoundEnd ended = run_round(next, round);
        const Rule& rule = *std::find_if(std::begin(kRules), std::end(kRules),
                                         [&](const Rule& of) { return of.end == ended; });
        Stopwatch watch;
        next = rule.follow(round);
        report.seconds.check += watch.lap();
        // A step that fails may return to an earlier linearisation that raised no energy.
        if (next == Next::Fail && restore_least_rise(work, report)) next = Next::Assemble;
        if (next == Next::Accept) report.status = StepStatus::Done;
    }
    name_failure(state, work, round.violations, round.overrun, report);
    return round.overrun;
}

std::vector<RoundRule> list_round_rules()
{
    std::vector<RoundRule> rules;
    for (const Rule& rule : kRules) rules.push_back(rule.in_words);
    return rules;
}

}  // namespace arris

// SPDX-License-Identifier: GPL-3.0-or-later
// Joints whose rims push but do not pull: elastic bodies of random stiffness with discs in their holes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/path/walk.hpp"
#include "stage3_nonlinear/results/sensitivity.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3 {
namespace {

constexpr int n_waves = 4;

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

double decades(std::mt19937& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

/// Size of a random joint.
struct Kind {
  Index n_holes, n_directions;
  bool floating;  ///< the first plate hangs on its fasteners alone
  double gaps;    ///< their size beside what the load moves
  double mu = 0;
};

/// Shears of the rims: random loads of the body, which leave nothing over with what they leave to the discs.
/// @param H Moments of a rim by a translation, (k, a). @param G Displacements of the body by its unknowns.
void add_shears(std::mt19937& random, const MatrixXd& H, const MatrixXd& G, PlateModel& body) {
  const Index k = H.rows(), a = H.cols(), n = G.rows(), n_holes = std::ssize(body.holes);
  MatrixXd motion(n, a);
  for (Index i = 0; i < n_holes; ++i) motion.middleRows(i * k, k) = H;
  motion.bottomRows(1) = Eigen::RowVector2d(1, 0).head(a);
  const MatrixXd to_balance = motion * (motion.transpose() * motion).inverse();
  body.R.resize(body.S.rows(), n_holes * k);
  for (Index i = 0; i < n_holes; ++i) {
    const auto& pressures = body.contact[i].pressures;
    MatrixXd drag(a, k);
    for (int axis = 0; axis < a; ++axis) drag.row(axis) = pressures.drag(axis).transpose();
    MatrixXd load = MatrixXd::Zero(n, k);
    load.middleRows(i * k, k) = MatrixXd::NullaryExpr(k, k, [&] { return uniform(random, -0.3, 0.3); });
    load += to_balance * (drag - motion.transpose() * load);
    auto R = body.R.middleCols(i * k, k);
    R = -G.transpose() * load;
    R.middleRows(i * a, a) += drag;
    for (int shear = 0; shear < k; ++shear) {
      body.friction_hole.push_back(body.holes[i]);
      body.friction_bearing.push_back(rim::shear_name(shear));
    }
  }
  body.friction_unit_force = body.friction_resultant = VectorXd::Zero(n_holes * k);
}

/// A body with `n_holes` rims of contact and one external along x. With the moments v of the rims' own displacement and
/// the external's as unknowns its stiffness P is symmetric and positive definite, or zero for a translation; moments of
/// the discs against the rims, m = H D - v, make of it that of discs, external and moments.
PlateModel random_body(std::mt19937& random, const Kind& kind, bool floating) {
  const rim::Harmonics pressures{n_waves};
  const Index k = pressures.size(), n = kind.n_holes * k + 1, a = kind.n_directions, m = kind.n_holes * a;
  MatrixXd P = MatrixXd::NullaryExpr(n, n, [&] { return uniform(random, -1, 1); });
  P = (1000.0 / double(n) * P * P.transpose()).eval();
  P.diagonal().array() += 300;
  MatrixXd H = MatrixXd::Zero(k, a);  // means of the distributions times cos theta and sin theta
  H(1, 0) = std::numbers::sqrt2 / 2;
  if (a > 1) H(2, 1) = std::numbers::sqrt2 / 2;
  if (floating) {  // no stiffness against moving along the axes
    MatrixXd motion = MatrixXd::Zero(n, a);
    for (Index i = 0; i < kind.n_holes; ++i) motion.middleRows(i * k, k) = H;
    motion(n - 1, 0) = 1;
    const MatrixXd rest =
        MatrixXd::Identity(n, n) - motion * (motion.transpose() * motion).inverse() * motion.transpose();
    P = (rest * P * rest).eval();
  }
  MatrixXd G = MatrixXd::Zero(n, m + 1 + n - 1);
  for (Index i = 0; i < kind.n_holes; ++i) {
    G.block(i * k, i * a, k, a) = H;
    G.block(i * k, m + 1 + i * k, k, k) = -MatrixXd::Identity(k, k);
  }
  G(n - 1, m) = 1;
  PlateModel body;
  for (Index i = 0; i < kind.n_holes; ++i) {
    body.holes.push_back(std::to_string(i + 1));
    body.contact.push_back({body.holes.back(), pressures, decades(random, 100, 10000), 1, 1});
  }
  body.on_springs.assign(body.holes.size(), true);
  for (Index d = 0; d < a; ++d) body.axes.push_back(static_cast<int>(d));
  for (Index i = 0; i < m; ++i) body.discs.push_back(i);
  body.externals = {"P"};
  body.external_axis = {0};
  body.S = G.transpose() * P * G;
  body.R = body.T = MatrixXd::Zero(body.S.rows(), 0);
  if (kind.mu > 0) add_shears(random, H, G, body);
  body.degrees = {Eigen::VectorXi::Constant(1, 8), {body.S}, {body.R}, {body.T}, {MatrixXd::Zero(0, 0)}};
  body.S_error = MatrixXd::Zero(body.S.rows(), body.S.rows());
  body.external_force = VectorXd::Zero(1);
  body.external_displacement.resize(1);
  body.traction_force = VectorXd::Zero(0);
  return body;
}

std::shared_ptr<const Law> random_law(std::mt19937& random) {
  const double kind = uniform(random, 0, 1), k = decades(random, 100, 100000);
  if (kind < 0.2) return test::law_of(R"({"type": "rigid"})");
  if (kind < 0.5) return test::linear_law(k);
  if (kind < 0.75) return test::bilinear_law(k, decades(random, 0.1, 10), 0.2 * k);
  return test::power_law(decades(random, 10, 10000), uniform(random, 0.4, 1));
}

JointModel random_contact_joint(std::mt19937& random, const Kind& kind) {
  JointModel joint;
  joint.file = "joint.json";
  joint.p = 8;
  joint.plates = {random_body(random, kind, kind.floating), random_body(random, kind, false)};
  joint.plates[0].name = "a", joint.plates[1].name = "b";
  joint.axes = joint.plates[0].axes;
  joint.plates[0].external_force[0] = 1;
  if (!kind.floating && uniform(random, 0, 1) < 0.3) joint.plates[0].external_displacement[0] = 0.01;
  for (Index i = 0; i < kind.n_holes; ++i) {
    test::add_fastener(joint, {{0, i * kind.n_directions}, {1, i * kind.n_directions}}, random_law(random));
    joint.planes.back().law_name = joint.fasteners.back().id;
    for (HoleModel& hole : joint.fasteners.back().holes) hole.mu = kind.mu;
    for (HoleModel& hole : joint.fasteners.back().holes)
      hole.gap = (uniform(random, 0, 1) < 0.3 ? -1 : 1) * kind.gaps * 0.003 * uniform(random, 0, 1);
  }
  return joint;
}

class ContactJoint : public testing::Test {
 protected:
  std::mt19937 random_{14};
  Kind kind(int i) { return {1 + i % 4, 1 + i % 2, i % 3 == 0, decades(random_, 1e-4, 1e2)}; }
};

TEST_F(ContactJoint, AThousandAreSolvedFromNothingAndHaveOneSolution) {
  Index most = 0;
  for (int i = 0; i < 1000; ++i) {
    const JointModel joint = random_contact_joint(random_, kind(i));
    const JointEquations equations = make_equations(joint);
    const double scale = force_scale(equations, 1);
    const RootProblem problem = root_problem(equations, 1, scale);
    const Index n = equations.n_unknowns();
    const VectorXd far = VectorXd::NullaryExpr(n, [&] { return uniform(random_, -10, 10); });
    std::vector<VectorXd> F;
    for (const VectorXd& start : {VectorXd(VectorXd::Zero(n)), far}) {
      const Root root = newton_root(problem, start, {1e-12, 200});
      EXPECT_LT(root.residual.lpNorm<Eigen::Infinity>(), 1e-10) << "joint " << i;
      F.push_back(contact_state(equations, scale * root.x).F);
      if (start.isZero(0)) most = std::max<Index>(most, root.iterations);
    }
    EXPECT_LT((F[0] - F[1]).lpNorm<Eigen::Infinity>(), 1e-8 * scale) << "joint " << i;
  }
  EXPECT_LE(most, 60);
  RecordProperty("most_iterations", static_cast<int>(most));
}

/// The Hessian is the derivative of the gradient, and positive semi-definite.
TEST_F(ContactJoint, HaveAConvexFunction) {
  constexpr double step = 1e-7;
  for (int i = 0; i < 60; ++i) {
    const JointModel joint = random_contact_joint(random_, kind(i));
    const JointEquations equations = make_equations(joint);
    const RootProblem problem = root_problem(equations, 1, 1);
    const Index n = equations.n_unknowns();
    const VectorXd x = VectorXd::NullaryExpr(n, [&] { return uniform(random_, -1, 1); });
    const VectorXd direction = VectorXd::NullaryExpr(n, [&] { return uniform(random_, -1, 1); });
    const auto gradient = [&](const VectorXd& at) { return problem.gradient(problem.residual(at)); };
    const auto slope = [&](double side) { return gradient(x + side * step * direction); };
    const VectorXd difference = (slope(1) - slope(-1)) / (2 * step);
    const MatrixXd H = hessian(equations, contact_state(equations, x));
    EXPECT_LT((H * direction - difference).norm(), 1e-4 * (H * direction).norm()) << "joint " << i;
    EXPECT_LT((H - H.transpose()).norm(), 1e-12 * H.norm());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(H).eigenvalues()[0], -1e-12 * H.norm()) << "joint " << i;
  }
}

TEST_F(ContactJoint, PathsAreFollowedAndUnloadedToWhereTheyBegan) {
  for (int i = 0; i < 60; ++i) {
    const JointModel joint = random_contact_joint(random_, kind(i));
    const JointEquations equations = make_equations(joint);
    const LoadPath path = follow(equations, {0.5, 1, -1, 0.5, 0}, {});
    ASSERT_FALSE(path.failure) << "joint " << i;
    const double scale = force_scale(equations, 1);
    EXPECT_LT((path.steps[0].F - path.steps[3].F).norm(), 1e-8 * scale) << "joint " << i;
    EXPECT_LT((path.steps[0].rim_F - path.steps[3].rim_F).norm(), 1e-7 * scale) << "joint " << i;
    if (equations.interference() == 0) {
      EXPECT_LT(path.steps[4].F.norm(), 1e-9 * scale) << "joint " << i;
    }
  }
}

/// With friction there is no convex function: joints are still solved, and from far away with the same forces up to
/// coefficients that no dry metals have. Far above them some have more solutions than one.
TEST_F(ContactJoint, WithFrictionAreSolvedFromNothingAndFromFarAway) {
  for (const auto& [mu, n_joints] : {std::pair(0.15, 20), {0.3, 20}, {0.6, 20}, {1.0, 20}, {2.0, 60}}) {
    int different = 0;
    for (int i = 0; i < n_joints; ++i) {
      Kind its = kind(i);
      its.mu = mu;
      const JointEquations equations = make_equations(random_contact_joint(random_, its));
      const double scale = force_scale(equations, 1);
      const LoadPath path = follow(equations, {1}, {});
      ASSERT_FALSE(path.failure) << "joint " << i << ", friction " << mu;
      const Index n = equations.n_unknowns();
      const VectorXd far = VectorXd::NullaryExpr(n, [&] { return uniform(random_, -10, 10); });
      const Root root = newton_root(root_problem(equations, 1, scale), far, {1e-12, 200});
      const VectorXd F = contact_state(equations, scale * root.x).F;
      different += root.converged && !((F - path.steps[0].all_F()).lpNorm<Eigen::Infinity>() < 1e-8 * scale);
    }
    EXPECT_EQ(different > 0, mu > 1) << different << " joints, friction " << mu;
  }
}

TEST_F(ContactJoint, TheTangentKnowsFriction) {
  constexpr double step = 1e-7;
  for (int i = 0; i < 60; ++i) {
    Kind its = kind(i);
    its.mu = 0.3;
    const JointEquations equations = make_equations(random_contact_joint(random_, its));
    const RootProblem problem = root_problem(equations, 1, 1);
    const auto random = [&] { return uniform(random_, -1, 1); };
    const VectorXd x = VectorXd::NullaryExpr(equations.n_unknowns(), random);
    const VectorXd direction = VectorXd::NullaryExpr(equations.n_unknowns(), random);
    const VectorXd difference =
        (problem.residual(x + step * direction) - problem.residual(x - step * direction)) / (2 * step);
    const VectorXd slope = tangent(equations.system, contact_state(equations, x)) * direction;
    EXPECT_LT((slope - difference).norm(), 1e-4 * slope.norm()) << "joint " << i;
  }
}

/// At its event a rim is on the mark, and between events nothing passes one, by states solved in between.
TEST_F(ContactJoint, HaveAnIncrementAtEveryEvent) {
  const PathOptions tight{{}, {.tolerance = 1e-13}};
  int events = 0;
  for (int i = 0; i < 24; ++i) {
    const JointModel joint = random_contact_joint(random_, {1 + i % 4, 1 + i % 2, false, decades(random_, 0.01, 1)});
    const JointEquations equations = make_equations(joint);
    const ContactCorners corners(equations);
    const LoadPath path = follow_events(equations, tight);
    ASSERT_FALSE(path.failure) << "joint " << i;
    Walk walk(equations, tight);
    double begin = first_load_factor;
    for (const auto& step : path.steps) {
      const VectorXd c = coordinates(equations, step.all_F(), step.all_delta());
      for (const auto& event : step.events) {
        if (event.kind != CornerKind::touch && event.kind != CornerKind::part) continue;
        ++events;
        // A loose bolt touches where it presses by a millionth of its gap.
        const RimContact& rim = equations.rims[(event.plane - equations.n_planes()) / 2];
        const double pressed = event.kind == CornerKind::touch ? 2e-6 * rim.stiffness() * std::abs(rim.gap()) : 0;
        const double away = std::abs(corners.position(c, event.plane));
        EXPECT_LE(away, 1e-8 * c.cwiseAbs().maxCoeff() + pressed) << "joint " << i << " " << rim.gap();
      }
      std::optional<Eigen::VectorXi> passed;
      for (int sample = 1; sample < 10 && step.load_factor - begin > 1e-4; ++sample) {
        ASSERT_TRUE(walk.reach(begin + sample * (step.load_factor - begin) / 10));
        Eigen::VectorXi here = corners.passed(walk.here().c);
        for (Index entry = equations.n_planes(); entry < here.size(); ++entry) {  // a loose bolt lies anywhere
          const RimContact& rim = equations.rims[(entry - equations.n_planes()) / 2];
          const double near = 1e-4 * rim.stiffness() * std::abs(rim.gap());
          if (passed && std::abs(corners.position(walk.here().c, entry)) < near) here[entry] = (*passed)[entry];
        }
        EXPECT_EQ(here, passed.value_or(here)) << "joint " << i << " at " << walk.here().load_factor;
        passed = here;
      }
      begin = step.load_factor;
    }
  }
  EXPECT_GT(events, 60);
}

/// What rims do between increments is told at the next, and undone on the way back.
TEST_F(ContactJoint, TellWhatTheirRimsHaveDoneByAnIncrement) {
  const JointModel joint = random_contact_joint(random_, {3, 2, false, 1});
  const JointEquations equations = make_equations(joint);
  const ContactCorners corners(equations);
  const LoadPath path = follow(equations, {0.2, 0.4, 0.6, 0.8, 1, 0.2}, {});
  ASSERT_FALSE(path.failure);
  Eigen::VectorXi passed = corners.passed(VectorXd::Zero(equations.n_unknowns()));
  std::size_t events = 0;
  for (const auto& step : path.steps) {
    for (const auto& event : step.events) passed[event.plane] += event.back ? -1 : 1;
    EXPECT_EQ(passed, corners.passed(coordinates(equations, step.all_F(), step.all_delta())));
    events += step.events.size();
  }
  EXPECT_GE(events, 3U);
  const ContactEvent touches{joint.n_planes() + 2, CornerKind::touch, false}, opens{0, CornerKind::contact, true};
  const ContactEvent parts{joint.n_planes() + 1, CornerKind::part, false};
  EXPECT_EQ(event_text(joint, {touches, opens, parts}), "a:2 touches; a:1 loses full contact; 1 opens");
}

/// The same plate with its external, which a force loads, among what is eliminated: a traction on a boundary that moves
/// as one.
PlateModel under_traction(PlateModel plate) {
  const Index e = plate.n_discs(), n = plate.n_unknowns();
  std::vector<Index> rest;
  for (Index i = 0; i < n; ++i)
    if (i != e) rest.push_back(i);
  const double S_ee = plate.S(e, e);
  const MatrixXd S = plate.S;
  plate.T = S(rest, {e}) / S_ee;
  plate.S = S(rest, rest) - S(rest, {e}) * S({e}, rest) / S_ee;
  plate.R = MatrixXd::Zero(n - 1, 0);
  plate.degrees = {plate.degrees.p, {plate.S}, {plate.R}, {plate.T}, {MatrixXd::Constant(1, 1, 1 / S_ee)}};
  plate.S_error = MatrixXd::Zero(n - 1, n - 1);
  plate.tractions = std::exchange(plate.externals, {});
  plate.traction_axis = std::exchange(plate.external_axis, {});
  plate.traction_force = std::exchange(plate.external_force, VectorXd::Zero(0));
  plate.external_displacement.clear();
  return plate;
}

/// By differences; and of a boundary that moves as one it is the same by its traction.
TEST_F(ContactJoint, HaveTheStiffnessOfDifferences) {
  constexpr double change = 1e-5;
  const PathOptions tight{{}, {.tolerance = 1e-13}};
  int compared = 0;
  for (int i = 0; i < 60; ++i) {
    JointModel joint = random_contact_joint(random_, kind(i));
    const JointEquations equations = make_equations(joint);
    const LoadPath path = follow(equations, {1, 1 - change, 1 + change, 1 - change / 2, 1 + change / 2}, tight);
    ASSERT_FALSE(path.failure);
    const auto between = [&](std::size_t low, std::size_t high) {
      const PlateState a = joint_state(joint, equations.system, path.steps[low]).plates[0];
      const PlateState b = joint_state(joint, equations.system, path.steps[high]).plates[0];
      return (b.Pe[0] - a.Pe[0]) / (b.De[0] - a.De[0]);
    };
    const double stiffness = tangent_stiffness(joint, equations, path.steps[0]).at(0).stiffness;
    if (std::abs(between(1, 2) / between(3, 4) - 1) < 1e-6) {  // no corner is near
      ++compared;
      EXPECT_NEAR(stiffness / between(3, 4), 1, 1e-5) << "joint " << i;
    }
    if (joint.plates[0].external_displacement[0]) continue;
    joint.plates[0] = under_traction(joint.plates[0]);
    const JointEquations others = make_equations(joint);
    const auto other = tangent_stiffness(joint, others, follow(others, {1}, tight).steps.at(0)).at(0);
    EXPECT_EQ(other.external, "a:P");
    EXPECT_NEAR(other.stiffness / stiffness, 1, 1e-7) << "joint " << i;
  }
  EXPECT_GT(compared, 40);
}

/// dF by each gap against central differences of joints solved anew.
TEST_F(ContactJoint, SensitivitiesToGapsAreDifferences) {
  constexpr double step = 1e-6;
  int compared = 0;
  for (int i = 0; i < 60; ++i) {
    Kind its = kind(i);
    if (i >= 40) its.mu = 0.2;
    JointModel joint = random_contact_joint(random_, its);
    const PathOptions options{{}, {.tolerance = 1e-13}};
    const JointEquations equations = make_equations(joint);
    const LoadPath path = follow(equations, {1}, options);
    ASSERT_FALSE(path.failure);
    const MatrixXd by_gap = sensitivity(equations, joint_numbers(joint, equations.system), path.steps[0]).gap;
    ASSERT_EQ(by_gap.cols(), 2 * std::ssize(joint.fasteners));
    for (Index rim = 0; rim < by_gap.cols(); ++rim) {
      const Index n = std::ssize(joint.fasteners);
      double& gap = joint.fasteners[rim % n].holes[rim / n].gap;  // rims stand plate after plate
      const auto at = [&](double change) {
        gap += change;
        const LoadPath changed = follow(make_equations(joint), {1}, options);
        gap -= change;
        return amounts(changed.steps.at(0).F, joint.n_directions());
      };
      const VectorXd difference = (at(step) - at(-step)) / (2 * step), finer = (at(step / 2) - at(-step / 2)) / step;
      if ((difference - finer).norm() > 1e-3 * (1 + finer.norm())) continue;  // a corner is near
      ++compared;
      EXPECT_LT((by_gap.col(rim) - finer).norm(), 2e-3 * (1 + finer.norm())) << "joint " << i << ", rim " << rim;
    }
  }
  EXPECT_GT(compared, 120);
}

}  // namespace
}  // namespace fastjoint::stage3

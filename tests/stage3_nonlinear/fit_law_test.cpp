// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/fit_law.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "common/errors.hpp"
#include "stage3_nonlinear/least_squares.hpp"
#include "tests/support/message.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Vector3d;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

template <class Curve>
TestPoints points_of(int n, double first, double last, Curve curve) {
  TestPoints points;
  for (int i = 0; i < n; ++i) {
    const double delta = first + (last - first) * i / (n - 1);
    points.push_back({delta, curve(delta)});
  }
  return points;
}

double sigma(const Fit& fit, int i) { return std::sqrt(fit.covariance(i, i)); }

struct PowerConstants {
  double A, n, delta0;
  double operator()(double delta) const { return delta > delta0 ? A * std::pow(delta - delta0, n) : 0; }
};
class ExactPower : public testing::TestWithParam<PowerConstants> {};

TEST_P(ExactPower, IsFoundWithoutUncertainty) {
  const auto c = GetParam();
  const Fit fit = fit_power(points_of(20, 0, 0.2, c));
  EXPECT_NEAR(fit.constants[0], c.A, 1e-8 * c.A);
  EXPECT_NEAR(fit.constants[1], c.n, 1e-8);
  EXPECT_NEAR(fit.constants[2], c.delta0, 1e-8 * 0.2);
  EXPECT_TRUE(fit.has_uncertainty);
  EXPECT_LT(sigma(fit, 0), 1e-10 * c.A);
  EXPECT_LT(sigma(fit, 1), 1e-10);
  EXPECT_LT(sigma(fit, 2), 1e-10 * 0.2);
  EXPECT_LT(fit.rms, 1e-10 * c(0.2));
  EXPECT_EQ(fit.n_points, 20);
  EXPECT_THAT(fit.on_bound, ElementsAre(false, c.n == 1, c.delta0 == 0));
}

INSTANTIATE_TEST_SUITE_P(Each, ExactPower,
                         testing::Values(PowerConstants{9000, 0.6, 0.013}, PowerConstants{9000, 0.6, 0},
                                         PowerConstants{1e-3, 0.4, 0.02}, PowerConstants{500, 1, 0.013},
                                         PowerConstants{500, 1, 0}));

TEST(FitCubic, OfAnExactCubicIsFoundWithoutUncertainty) {
  const auto curve = [](double d) { return 3e4 * d - 9e4 * d * d + 2e5 * d * d * d; };
  const Fit fit = fit_cubic(points_of(9, 0, 0.3, curve));
  EXPECT_NEAR(fit.constants[0], 3e4, 1e-8 * 3e4);
  EXPECT_NEAR(fit.constants[1], -9e4, 1e-8 * 9e4);
  EXPECT_NEAR(fit.constants[2], 2e5, 1e-8 * 2e5);
  EXPECT_THAT(cubic_deltas(fit), ElementsAre(testing::DoubleEq(0.1), testing::DoubleEq(0.2), 0.3));
  for (const double delta : cubic_deltas(fit)) {
    EXPECT_NEAR(force(fit, delta), curve(delta), 1e-9 * curve(0.3));
    EXPECT_LT(force_uncertainty(fit, delta), 1e-10 * curve(0.3));
  }
  EXPECT_THAT(fit.warnings, IsEmpty());
}

/// A test of twelve points, its forces rounded.
const TestPoints measured{{.02, 419},  {.03, 693},  {.04, 971},  {.06, 1386}, {.08, 1745}, {.1, 1999},
                          {.13, 2370}, {.16, 2722}, {.19, 3117}, {.22, 3465}, {.26, 3802}, {.3, 4110}};

/// By scipy 1.10: curve_fit(lambda x, A, n, d: A * (x - d)**n, delta, F, p0=[9000, .6, .01], xtol=1e-14) with its
/// covariance, and numpy.linalg.lstsq of [x, x**2, x**3] with covariance res / 9 * inv(X.T @ X).
TEST(FitPower, IsThatOfAnotherProgram) {
  const Fit fit = fit_power(measured);
  EXPECT_NEAR(fit.constants[0], 8848.396609, 1e-3);
  EXPECT_NEAR(fit.constants[1], 0.6048590193, 1e-7);
  EXPECT_NEAR(fit.constants[2], 0.0139527669, 1e-8);
  EXPECT_NEAR(sigma(fit, 0), 159.401860, 2e-2);  // scipy's derivatives are differences
  EXPECT_NEAR(sigma(fit, 1), 0.0121005474, 2e-6);
  EXPECT_NEAR(sigma(fit, 2), 0.00111138170, 2e-7);
  EXPECT_NEAR(fit.rms, 31.465106559, 1e-6);
  EXPECT_NEAR(force(fit, 0.2), 3199.55511, 1e-3);
  EXPECT_NEAR(force_uncertainty(fit, 0.2), 13.5413918, 2e-3);
  EXPECT_EQ(force_uncertainty(fit, 0.01), 0);
  EXPECT_THAT(fit.warnings, IsEmpty());
}

TEST(FitCubic, IsThatOfAnotherProgram) {
  const Fit fit = fit_cubic(measured);
  EXPECT_NEAR(force(fit, 0.1), 2006.003394569, 1e-6);
  EXPECT_NEAR(force(fit, 0.2), 3216.132336839, 1e-6);
  EXPECT_NEAR(force(fit, 0.3), 4138.234372871, 1e-6);
  EXPECT_NEAR(force_uncertainty(fit, 0.1), 24.299093210, 1e-6);
  EXPECT_NEAR(force_uncertainty(fit, 0.2), 30.312284532, 1e-6);
  EXPECT_NEAR(force_uncertainty(fit, 0.3), 51.495346479, 1e-6);
}

TEST(FitLaw, FollowsTheUnits) {
  auto inches = measured;
  for (auto& [delta, F] : inches) delta /= 25.4, F /= 4.448;
  const Fit mm = fit_power(measured), in = fit_power(inches);
  EXPECT_NEAR(in.constants[1], mm.constants[1], 1e-9);
  EXPECT_NEAR(sigma(in, 1), sigma(mm, 1), 1e-9);
  EXPECT_NEAR(in.constants[2] * 25.4, mm.constants[2], 1e-10);
  EXPECT_NEAR(force_uncertainty(in, 0.2 / 25.4) * 4.448, force_uncertainty(mm, 0.2), 1e-6);
  EXPECT_NEAR(force_uncertainty(fit_cubic(inches), 0.2 / 25.4) * 4.448, force_uncertainty(fit_cubic(measured), 0.2),
              1e-6);
}

const PowerConstants truth{9000, 0.6, 0.01};
double true_cubic(double d) { return 3e4 * d - 9e4 * d * d + 2e5 * d * d * d; }

/// `n` points of a curve past contact, each with a scatter of 30.
template <class Curve>
TestPoints scattered(std::mt19937& random, int n, Curve curve) {
  std::normal_distribution<double> scatter(0, 30);
  return points_of(n, 0.017, 0.21, [&](double d) { return curve(d) + scatter(random); });
}

/// One standard uncertainty either side holds the truth in 68 % of all tests; of 500, 2 % is the scatter of that.
TEST(FitPower, HasHonestUncertainties) {
  std::mt19937 random(1);
  constexpr int n_tests = 500;
  Vector3d inside = Vector3d::Zero();
  for (int test = 0; test < n_tests; ++test) {
    const Fit fit = fit_power(scattered(random, 30, truth));
    const Vector3d error = (fit.constants - Vector3d(truth.A, truth.n, truth.delta0)).cwiseAbs();
    for (int i = 0; i < 3; ++i) inside[i] += error[i] < sigma(fit, i) ? 100.0 / n_tests : 0;
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_GT(inside[i], 60) << i;
    EXPECT_LT(inside[i], 76) << i;
  }
}

TEST(FitCubic, HasHonestUncertainties) {
  std::mt19937 random(1);
  constexpr int n_tests = 500;
  Vector3d inside = Vector3d::Zero();
  for (int test = 0; test < n_tests; ++test) {
    const Fit fit = fit_cubic(scattered(random, 12, true_cubic));
    const auto deltas = cubic_deltas(fit);
    for (std::size_t i = 0; i < 3; ++i)
      inside[static_cast<int>(i)] +=
          std::abs(force(fit, deltas[i]) - true_cubic(deltas[i])) < force_uncertainty(fit, deltas[i]) ? 100.0 / n_tests
                                                                                                      : 0;
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_GT(inside[i], 60) << i;
    EXPECT_LT(inside[i], 76) << i;
  }
}

double rms_error_of_A(int n_points) {
  std::mt19937 random(3);
  constexpr int n_tests = 400;
  double sum = 0;
  for (int test = 0; test < n_tests; ++test)
    sum += std::pow(fit_power(scattered(random, n_points, truth)).constants[0] - truth.A, 2);
  return std::sqrt(sum / n_tests);
}

/// Sixteen times as many points, a quarter of the error; each side of the ratio is known to 1 / sqrt(800) = 3.5 %.
TEST(FitPower, ErrorFallsWithTheRootOfTheNumberOfPoints) {
  EXPECT_NEAR(rms_error_of_A(20) / rms_error_of_A(320), 4, 0.6);
}

TEST(FitPower, HoldsDelta0AtZeroWhereItWouldBeLess) {
  const Fit fit = fit_power(points_of(20, 0.01, 0.2, PowerConstants{9000, 0.6, -0.02}));
  EXPECT_EQ(fit.constants[2], 0);
  EXPECT_EQ(sigma(fit, 2), 0);
  EXPECT_THAT(fit.on_bound, ElementsAre(false, false, true));
  EXPECT_LT(fit.constants[1], 0.6);
  EXPECT_GT(sigma(fit, 1), 0);
}

/// 12 (delta - 0.05)^0.5 from 0.1 on, but no force yet at 0.07: contact cannot come before.
TEST(FitPower, PutsContactBehindPointsWithoutForce) {
  auto points = points_of(20, 0.1, 1, PowerConstants{12, 0.5, 0.05});
  const Fit free = fit_power(points);
  EXPECT_NEAR(free.constants[2], 0.05, 1e-9);
  points.push_back({0, 0});
  points.push_back({0.07, 0});
  const Fit held = fit_power(points);
  EXPECT_NEAR(held.constants[2], 0.07, 1e-15);
  EXPECT_THAT(held.on_bound, ElementsAre(false, false, true));
  EXPECT_EQ(held.n_points, 22);
  EXPECT_GT(held.rms, 0);
}

TEST(FitPower, WarnsOfNOnItsBound) {
  const Fit fit = fit_power(points_of(20, 0.01, 0.2, PowerConstants{9000, 1.5, 0}));
  EXPECT_EQ(fit.constants[1], 1);
  EXPECT_THAT(fit.warnings, ElementsAre("n is on its bound 1: the points rise as a line or steeper and steeper"));
}

TEST(FitLaw, WarnsOfTooFewPointsForAnUncertainty) {
  const auto few = points_of(3, 0.1, 0.3, PowerConstants{12, 0.5, 0.05});
  for (const Fit& fit : {fit_power(few), fit_cubic(few)}) {
    EXPECT_FALSE(fit.has_uncertainty);
    EXPECT_EQ(fit.covariance.norm(), 0);
    EXPECT_THAT(fit.warnings, ElementsAre("3 points past contact are too few for the uncertainty of 3 constants"));
    for (const auto& [delta, F] : few) EXPECT_NEAR(force(fit, delta), F, 1e-9 * F);
  }
}

/// Points before contact tell nothing of the scatter past it.
TEST(FitPower, PointsBeforeContactGiveNoUncertainty) {
  auto few = points_of(3, 0.1, 0.3, PowerConstants{12, 0.5, 0.05});
  for (const double delta : {0.0, 0.01, 0.02, 0.03}) few.push_back({delta, 0});
  EXPECT_FALSE(fit_power(few).has_uncertainty);
}

TEST(FitCubic, WarnsWhereItDoesNotRise) {
  const Fit fit = fit_cubic(points_of(7, 0, 3, [](double x) { return x * (6.5 - 4.75 * x + x * x); }));
  EXPECT_THAT(fit.warnings, ElementsAre(HasSubstr("does not rise everywhere up to its last delta 3: its slope at delta "
                                                  "= 1.583 is -1.021")));
}

std::string refusal(Fit (*fit)(const TestPoints&), const TestPoints& points) {
  return test::message_of([&] { return fit(points); });
}

TEST(FitLaw, RefusesTooFewPoints) {
  for (const auto fit : {fit_power, fit_cubic}) {
    EXPECT_EQ(refusal(fit, {{0, 0}, {1, 2}, {2, 3}}),
              "forces > 0 at 2 different delta > 0; allowed: at 3 or more of them");
    EXPECT_EQ(refusal(fit, {{1, 1}, {1, 2}, {1, 3}}),
              "forces > 0 at 1 different delta > 0; allowed: at 3 or more of them");
    EXPECT_EQ(refusal(fit, {{1, 0}, {2, 0}, {3, 0}}),
              "forces > 0 at 0 different delta > 0; allowed: at 3 or more of them");
  }
}

TEST(FitLaw, RefusesNumbersWhoseSquaresOverflow) {
  const auto points = [](double length, double force) {
    return TestPoints{{1 * length, 1 * force}, {2 * length, 1.5 * force}, {3 * length, 1.8 * force}};
  };
  EXPECT_THAT(
      [&] { (void)fit_power(points(1e200, 1)); },
      ThrowsMessage<InputError>(HasSubstr("the largest delta is 3e+200; allowed: 1e-60 to 1e+60, in other units")));
  EXPECT_THAT(
      [&] { (void)fit_cubic(points(1, 1e-200)); },
      ThrowsMessage<InputError>(HasSubstr("the largest F is 1.8e-200; allowed: 1e-60 to 1e+60, in other units")));
  for (const double unit : {1e-59, 1e59}) {
    EXPECT_NEAR(fit_power(points(unit, 1)).constants[1], fit_power(points(1, 1)).constants[1], 1e-9);
    EXPECT_TRUE(fit_cubic(points(1 / unit, unit)).constants.allFinite());
  }
}

TEST(FitPower, RefusesForcesThatDoNotGrow) {
  EXPECT_EQ(refusal(fit_power, {{1, 4}, {2, 2}, {4, 1}}),
            "the force does not grow with delta, the power law that fits best has n = -1; allowed: a test whose force "
            "grows");
}

TEST(FitCubic, RefusesOneThatIsBelowZeroAtItsPoints) {
  // delta (delta - 1.5)^2 - 0.1 delta at 1 and 2 and 3 is 0.15, 0.3 and 6.45; a third of 4.5 is where it is negative.
  EXPECT_EQ(refusal(fit_cubic, points_of(10, 0, 4.5, [](double d) { return d * (d - 1.5) * (d - 1.5) - 0.1 * d; })),
            "the cubic that fits best has F = -0.15 at delta = 1.5; allowed: a test whose cubic is above 0 at a third, "
            "two thirds and all of its last delta");
}

/// The sum of this hump falls ever more steeply until contact meets the first point, past which only a step is left.
TEST(FitPower, SaysWhenItsSearchDoesNotEnd) {
  EXPECT_THAT(
      [] {
        (void)fit_power({{0.25, 0.0325}, {0.5, 0.4588}, {0.75, 0.6867}, {1, 0.2878}});
      },
      ThrowsMessage<NumericalError>("the search for a power law did not end; leave out points before contact "
                                    "and after failure"));
}

TEST(LeastSquares, LetsOutWhatTheProblemThrows) {
  const ResidualProblem problem{[](const Eigen::VectorXd& x) -> Eigen::VectorXd {
                                  if (x[0] != 1) throw std::runtime_error("not here");
                                  return Eigen::Vector2d(x[0], 2 * x[0]);
                                },
                                [](const Eigen::VectorXd&) -> Eigen::MatrixXd { return Eigen::Vector2d(1, 2); }};
  EXPECT_THAT([&] { (void)nonlinear_least_squares(problem, Eigen::VectorXd::Ones(1)); },
              ThrowsMessage<std::runtime_error>("not here"));
}

}  // namespace
}  // namespace fastjoint::stage3

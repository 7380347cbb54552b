// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/fit_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fastjoint::stage3 {
namespace {

constexpr double width = 640, height = 420, left = 80, right = 20, top = 40, bottom = 60;  // pixels
constexpr const char* blue = "#1f5fa8";

/// Where a displacement and a force stand on the page.
struct Page {
  double greatest_delta, greatest_F;
  [[nodiscard]] double x(double delta) const { return left + (width - left - right) * delta / greatest_delta; }
  [[nodiscard]] double y(double F) const { return height - bottom - (height - top - bottom) * F / greatest_F; }
  [[nodiscard]] std::string at(double delta, double F) const { return fmt::format("{:.2f},{:.2f} ", x(delta), y(F)); }
};

/// 1, 2 or 5 times a power of ten, such that about six of them make up the range.
double tick_step(double range) {
  const double power = std::pow(10, std::floor(std::log10(range / 6)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (range / (digit * power) <= 6.5) return digit * power;
  return 10 * power;
}

/// From contact on, closer there, where a power law turns sharply.
std::vector<double> samples(const Fit& fit) {
  constexpr int n = 120;
  const double contact = fit.kind == Fit::Kind::power ? fit.constants[2] : 0;
  std::vector<double> deltas{0};
  for (int i = 0; i <= n; ++i) deltas.push_back(contact + (fit.last_delta - contact) * i * i / (n * n));
  return deltas;
}

Page page_of(const Fit& fit, const TestPoints& points, const std::vector<double>& deltas) {
  constexpr double air = 1.05;
  Page page{air * fit.last_delta, 0};
  for (const auto& point : points) page.greatest_F = std::max(page.greatest_F, air * point[1]);
  for (const double delta : deltas) page.greatest_F = std::max(page.greatest_F, air * force(fit, delta));
  return page;
}

std::string axes(const Page& page) {
  const double x0 = page.x(0), y0 = page.y(0), x1 = width - right, y1 = top;
  std::string svg = fmt::format(R"(<path d="M{:.2f},{:.2f} V{:.2f} H{:.2f}" fill="none" stroke="black"/>)"
                                "\n",
                                x0, y1, y0, x1);
  const auto tick = [&](double x, double y, int dx, int dy, const char* name, double value) {
    svg += fmt::format(R"(<path d="M{:.2f},{:.2f} l{},{}" stroke="black"/>)", x, y, -dx, dy);
    svg += fmt::format(R"(<text class="{}" x="{:.2f}" y="{:.2f}" text-anchor="{}">{:.6g}</text>)"
                       "\n",
                       name, x - 1.8 * dx, y + 3.2 * dy + 0.8 * dx, dx > 0 ? "end" : "middle", value);
  };
  const double delta_step = tick_step(page.greatest_delta), F_step = tick_step(page.greatest_F);
  for (int i = 0; i * delta_step <= page.greatest_delta; ++i)
    tick(page.x(i * delta_step), y0, 0, 6, "delta", i * delta_step);
  for (int i = 0; i * F_step <= page.greatest_F; ++i) tick(x0, page.y(i * F_step), 6, 0, "F", i * F_step);
  svg += fmt::format(R"(<text x="{:.2f}" y="{:.2f}" text-anchor="middle">delta</text>)"
                     "\n",
                     (x0 + x1) / 2, height - 15);
  svg += fmt::format(R"(<text x="20" y="{:.2f}" text-anchor="middle">F</text>)"
                     "\n",
                     (y0 + y1) / 2);
  return svg;
}

std::string band(const Fit& fit, const Page& page, const std::vector<double>& deltas) {
  std::string above, below;
  for (const double delta : deltas) {
    const double F = force(fit, delta), sigma = force_uncertainty(fit, delta);
    if (!fit.has_uncertainty || sigma >= F) continue;
    above += page.at(delta, F + sigma);
    below.insert(0, page.at(delta, F - sigma));
  }
  if (above.empty()) return {};
  return fmt::format(R"(<polygon points="{}{}" fill="{}" fill-opacity="0.25"/>)"
                     "\n",
                     above, below, blue);
}

std::string curve(const Fit& fit, const Page& page, const std::vector<double>& deltas) {
  std::string line;
  for (const double delta : deltas) line += page.at(delta, force(fit, delta));
  return fmt::format(R"(<polyline points="{}" fill="none" stroke="{}" stroke-width="1.5"/>)"
                     "\n",
                     line, blue);
}

}  // namespace

std::string drawing(const Fit& fit, const TestPoints& points) {
  const auto deltas = samples(fit);
  const Page page = page_of(fit, points, deltas);
  std::string svg = fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?>
<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" viewBox="0 0 {0} {1}" font-family="sans-serif" font-size="13">
<rect width="{0}" height="{1}" fill="white"/>
<text x="{2}" y="22">{3} law fitted to {4} points{5}</text>
)",
                                width, height, left, fit.kind == Fit::Kind::power ? "power" : "cubic", fit.n_points,
                                fit.has_uncertainty ? ", band of one standard uncertainty" : "");
  svg += axes(page) + band(fit, page, deltas) + curve(fit, page, deltas);
  for (const auto& [delta, F] : points)
    svg += fmt::format(R"(<circle cx="{:.2f}" cy="{:.2f}" r="3" fill="none" stroke="black"/>)"
                       "\n",
                       page.x(delta), page.y(F));
  return svg + "</svg>\n";
}

}  // namespace fastjoint::stage3

#include "analysis/avl.hpp"

#include <fmt/format.h>

#include <span>

#include "analysis/axes.hpp"

namespace alphadot {

namespace {

constexpr std::string_view rule = " ---------------------------------------------------------------\n";

/// A column of AVL's blocks: its variable, the letters behind the coefficient, its title.
struct Column {
  Variable variable;
  std::string_view suffix;
  std::string_view title;
};

constexpr Column static_columns[] = {{Variable::alpha, "a", "alpha"}, {Variable::beta, "b", "beta"}};
constexpr Column rate_columns[] = {{Variable::p, "p", "roll rate  p'"},
                                   {Variable::q, "q", "pitch rate  q'"},
                                   {Variable::r, "r", "yaw rate  r'"}};
constexpr Column acceleration_columns[] = {{Variable::alphadot, "ad", "alphadot"},
                                           {Variable::betadot, "bd", "betadot"}};

/// A line of AVL's blocks: its label and the coefficient, an index on stability axes.
struct Line {
  std::string_view label;
  int coefficient;
};

constexpr Line lines[] = {{" z' force CL |", 2}, {" y  force CY |", 1}, {" x  force CD |", 0},
                          {" x' mom.  Cl'|", 3}, {" y  mom.  Cm |", 4}, {" z' mom.  Cn'|", 5}};

std::string block(const DerivativeSet& derivatives, std::span<const Column> columns) {
  std::string title(18, ' '), underline(18, ' ');
  for (const auto& column : columns)
    if (derivatives.contains(column.variable)) {
      title += fmt::format("{:>16}    ", column.title);
      underline += "----------------    ";
    }
  if (title.size() == 18) return "";
  std::string out = title + "\n" + underline + "\n";
  for (const auto& line : lines) {
    out += line.label;
    for (const auto& column : columns)
      if (const auto found = derivatives.find(column.variable); found != derivatives.end())
        out += fmt::format(
            "{:>7} ={:>11.6f}",
            fmt::format("{}{}", names_in(Axes::stability)[static_cast<std::size_t>(line.coefficient)],
                        column.suffix),
            found->second[line.coefficient].value);
    out += "\n";
  }
  return out + "\n";
}

std::string header(const FlightPoint& point) {
  const auto& reference = point.reference;
  const Vec3& center = reference.moment_center;
  std::string out(rule);
  out += " alphadot: inviscid stability derivatives in the format of AVL\n\n";
  out += fmt::format(" Configuration: {}\n", point.title);
  if (!point.status.empty()) out += fmt::format(" Status: {}\n", point.status);
  out += "\n";
  out += fmt::format("  Sref ={:>9.5g}       Cref ={:>9.5g}       Bref ={:>9.5g}\n", reference.area,
                     reference.length, reference.length);
  out += fmt::format("  Xref ={:>9.5g}       Yref ={:>9.5g}       Zref ={:>9.5g}\n\n", center.x, center.y,
                     center.z);
  return out + " Standard axis orientation,  X fwd, Z down\n\n";
}

std::string totals(const FlightPoint& point, const Coefficients& stability) {
  const auto& c = point.steady;
  const auto& stream = point.freestream;
  std::string out;
  out +=
      fmt::format("  Alpha ={:>10.5f}     pb/2V ={:>10.5f}     p'b/2V ={:>10.5f}\n", stream.alpha, 0.0, 0.0);
  out += fmt::format("  Beta  ={:>10.5f}     qc/2V ={:>10.5f}\n", stream.beta, 0.0);
  out +=
      fmt::format("  Mach  ={:>10.3f}     rb/2V ={:>10.5f}     r'b/2V ={:>10.5f}\n\n", stream.mach, 0.0, 0.0);
  out += fmt::format("  CXtot ={:>10.5f}     Cltot ={:>10.5f}     Cl'tot ={:>10.5f}\n", -c.CA, c.Cl,
                     stability.Cl);
  out += fmt::format("  CYtot ={:>10.5f}     Cmtot ={:>10.5f}\n", c.CY, c.Cm);
  out += fmt::format("  CZtot ={:>10.5f}     Cntot ={:>10.5f}     Cn'tot ={:>10.5f}\n\n", -c.CN, c.Cn,
                     stability.Cn);
  return out + fmt::format("  CLtot ={:>10.5f}\n  CDtot ={:>10.5f}\n\n", stability.CN, stability.CA);
}

}  // namespace

std::string avl_stability_text(const FlightPoint& point) {
  const Real alpha = point.freestream.alpha * radians_per_degree;
  const DerivativeSet derivatives = to_stability_axes(point.derivatives, point.steady, alpha);
  std::string out = header(point) + totals(point, to_stability_axes(point.steady, alpha)) + std::string(rule);
  out += "\n Stability-axis derivatives...\n\n";
  out += block(derivatives, static_columns) + block(derivatives, rate_columns);
  out += block(derivatives, acceleration_columns);
  if (const auto found = derivatives.find(Variable::alpha); found != derivatives.end()) {
    // AVL's own definition, with CL for CN.
    const auto& slope = found->second;
    out += fmt::format(
        " Neutral point  Xnp ={:>11.6f}\n",
        point.reference.moment_center.x - point.reference.length * slope.Cm.value / slope.CN.value);
  }
  return out;
}

}  // namespace alphadot

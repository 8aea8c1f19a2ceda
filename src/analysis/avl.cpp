#include "analysis/avl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "analysis/axes.hpp"
#include "analysis/static_margin.hpp"

namespace alphadot {

namespace {

constexpr std::string_view rule = " ---------------------------------------------------------------\n";

/// A column of AVL's blocks: its variable, the letters behind the coefficient, its title.
template <class Text>
struct ColumnOf {
  Variable variable;
  Text suffix;
  Text title;
};
using Column = ColumnOf<std::string_view>;

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

// AVL has no drag among them; it stands in a block of its own.
constexpr Line lines[] = {{" z' force CL |", 2},
                          {" y  force CY |", 1},
                          {" x' mom.  Cl'|", 3},
                          {" y  mom.  Cm |", 4},
                          {" z' mom.  Cn'|", 5}};
constexpr Line drag_line[] = {{" x  force CD |", 0}};
constexpr Line all_lines[] = {lines[0], lines[1], drag_line[0], lines[2], lines[3], lines[4]};

/// Columns that are not known are there as nan, so that each number keeps its place.
template <class Columns>
std::string block(const DerivativeSet& derivatives, const Columns& columns, std::span<const Line> rows) {
  std::string title(14, ' '), underline(14, ' '), out;
  for (const auto& column : columns) {
    title += fmt::format("{:>20}", column.title);
    underline += "    ----------------";
  }
  out = title + "\n" + underline + "\n";
  for (const auto& row : rows) {
    out += row.label;
    for (const auto& column : columns) {
      const auto found = derivatives.find(column.variable);
      const Real value = found == derivatives.end() ? std::numeric_limits<Real>::quiet_NaN()
                                                    : found->second[row.coefficient].value;
      out += fmt::format(
          "{:>7} ={:>11.6f}",
          fmt::format("{}{}", names_in(Axes::stability)[static_cast<std::size_t>(row.coefficient)],
                      column.suffix),
          value);
    }
    out += "\n";
  }
  return out + "\n";
}

/// d01, d02, ... as AVL counts controls.
std::vector<ColumnOf<std::string>> control_columns(const DerivativeSet& derivatives) {
  std::vector<ColumnOf<std::string>> out;
  for (const auto& [variable, column] : derivatives)
    if (is_control(variable) && !is_control_rate(variable)) {
      const auto number = out.size() + 1;
      out.push_back(
          {variable, fmt::format("d{:02}", number), fmt::format("{}  d{}", name(variable), number)});
    }
  return out;
}

/// A reference in the twelve columns where AVL's readers look for it: they take the third to the eighth. A
/// number that would be another one when cut there has its exponent begin among them, so that it is none.
std::string reference_number(Real value) {
  const Real size = std::abs(value);
  if (size != 0 && !(size >= 1e-3 && size < 99999.5)) return fmt::format("{:<12.4e}", value);
  std::string digits;
  if (size != 0 && size < 0.1) {
    digits = fmt::format("{:.{}f}", value, value < 0 ? 8 : 9);
    digits.erase(digits.find("0."), 1);
  } else {
    digits = fmt::format("{:.{}f}", value, 7 - static_cast<int>(std::log10(std::max<Real>(size, 1))));
  }
  return fmt::format("  {:<10}", digits);
}

/// A title with line ends would move all lines after it.
std::string on_one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

std::string header(const FlightPoint& point) {
  const auto& reference = point.reference;
  const Vec3& center = reference.moment_center;
  std::string out(rule);
  out += " alphadot: inviscid stability derivatives in the format of AVL\n\n";
  out += fmt::format(" Configuration: {}{}{}\n", on_one_line(point.title),
                     point.title.empty() || point.origin.empty() ? "" : "; ", on_one_line(point.origin));
  // Three lines, as AVL has of its surfaces, strips and vortices.
  out += fmt::format(
      "    {}{}\n",
      reference.half_model ? "Half model: nan stands for what only a full one tells" : "Full model",
      point.status.empty() ? "" : "; Status: " + on_one_line(point.status));
  out += "    Per radian; rates by Cref and Bref, which both are the reference length\n";
  out += "    Drag, alphadot and betadot stand after the neutral point\n\n";
  out += "  Sref =" + reference_number(reference.area) + "   Cref =" + reference_number(reference.length) +
         "   Bref =" + reference_number(reference.length) + "\n";
  out += "  Xref =" + reference_number(center.x) + "   Yref =" + reference_number(center.y) +
         "   Zref =" + reference_number(center.z) + "\n\n";
  out += " Standard axis orientation,  X fwd, Z down\n\n";
  return out + " Run case:  alphadot\n\n";
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
  out += fmt::format("  CLtot ={:>10.5f}\n  CDtot ={:>10.5f}\n", stability.CN, stability.CA);
  out += fmt::format("  CDvis ={:>10.5f}     CDind ={:>10.5f}\n", 0.0, stability.CA);
  // AVL's Trefftz plane, which there is none of here.
  return out +
         "  CLff  =       nan     CDff  =       nan    | Trefftz\n"
         "  CYff  =       nan         e =       nan    | Plane  \n\n\n";
}

}  // namespace

std::string avl_stability_text(const FlightPoint& point) {
  const Real alpha = point.freestream.alpha * radians_per_degree;
  const DerivativeSet derivatives = to_stability_axes(point.derivatives, point.steady, alpha);
  std::string out = header(point) + totals(point, to_stability_axes(point.steady, alpha)) + std::string(rule);
  out += "\n Stability-axis derivatives...\n\n";
  out += block(derivatives, static_columns, lines) + block(derivatives, rate_columns, lines);
  const auto controls = control_columns(derivatives);
  if (!controls.empty()) out += block(derivatives, controls, lines);
  const auto found = point.derivatives.find(Variable::alpha);
  const Real margin = found == point.derivatives.end()
                          ? std::numeric_limits<Real>::quiet_NaN()
                          : static_margin(found->second.CN, found->second.Cm).value;
  out += fmt::format(" Neutral point  Xnp ={:>11.6f}\n\n",
                     point.reference.moment_center.x + point.reference.length * margin);
  out += block(derivatives, static_columns, drag_line) + block(derivatives, rate_columns, drag_line);
  if (!controls.empty()) out += block(derivatives, controls, drag_line);
  out += block(derivatives, acceleration_columns, all_lines);
  return out;
}

}  // namespace alphadot

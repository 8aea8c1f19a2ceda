#include "analysis/jsbsim.hpp"

#include <fmt/format.h>

#include <array>

#include "analysis/static_margin.hpp"

namespace alphadot {

namespace {

/// JSBSim's axes in the order of the coefficients.
constexpr std::array<std::string_view, 6> axis_names = {"AXIAL", "SIDE", "NORMAL", "ROLL", "PITCH", "YAW"};

std::string property(std::string_view name) {
  return fmt::format("<property>{}</property>", name);
}

std::string offset_from(std::string_view name, Real degrees) {
  return fmt::format("<difference>{}<value>{:.9g}</value></difference>", property(name),
                     degrees * radians_per_degree);
}

std::string reduced(std::string_view rate) {
  return property(rate) + property("aero/ci2vel");
}

/// The factors by which a derivative is multiplied in JSBSim's properties; empty for those that it has no
/// property for.
std::string factors_of(Variable variable, const FreestreamSettings& stream) {
  switch (variable) {
    case Variable::alpha:
      return offset_from("aero/alpha-rad", stream.alpha);
    case Variable::beta:
      return offset_from("aero/beta-rad", stream.beta);
    case Variable::p:
      return reduced("velocities/p-aero-rad_sec");
    case Variable::q:
      return reduced("velocities/q-aero-rad_sec");
    case Variable::r:
      return reduced("velocities/r-aero-rad_sec");
    case Variable::alphadot:
      return reduced("aero/alphadot-rad_sec");
    case Variable::betadot:
      return reduced("aero/betadot-rad_sec");
    default:
      return is_control(variable) && !is_control_rate(variable)
                 ? property(fmt::format("fcs/{}-rad", name(variable)))
                 : "";
  }
}

std::string function(const std::string& name, int coefficient, const std::string& factors, Real value) {
  const std::string scale =
      property("aero/qbar-area") + (coefficient < 3 ? "" : property("metrics/cbarw-ft"));
  return fmt::format(
      "    <function name=\"aero/coefficient/{}\">\n"
      "      <product>{}{}<value>{:.9g}</value></product>\n"
      "    </function>\n",
      name, scale, factors, value);
}

/// "label text" as a line of the comment, which must not hold two hyphens in a row.
std::string comment_line(const std::string& label, std::string text) {
  if (text.empty()) return "";
  for (std::size_t at; (at = text.find("--")) != std::string::npos;) text.insert(at + 1, " ");
  return fmt::format("\n       {}: {}.", label, text);
}

/// Where the normal force that goes with alpha acts.
std::string neutral_point_text(const FlightPoint& point) {
  const auto found = point.derivatives.find(Variable::alpha);
  if (found == point.derivatives.end()) return "";
  const auto margin = static_margin(found->second.CN, found->second.Cm);
  return fmt::format("\n       Neutral point at x = {:.6g}.",
                     point.reference.moment_center.x + point.reference.length * margin.value);
}

}  // namespace

std::string jsbsim_aerodynamics(const FlightPoint& point) {
  const auto& reference = point.reference;
  const auto& center = reference.moment_center;
  std::string out = fmt::format(
      "<aerodynamics>\n"
      "  <!-- alphadot: Mach {:g}, alpha {:g} deg, beta {:g} deg. Linear about this condition.\n"
      "       Needs in the vehicle's metrics, in the mesh's unit: chord {:g}, wingarea {:g}, AERORP at "
      "({:g}, {:g}, "
      "{:g});\n"
      "       the centre of gravity should be there too, for the rates are about it.{}{}{} -->\n",
      point.freestream.mach, point.freestream.alpha, point.freestream.beta, reference.length, reference.area,
      center.x, center.y, center.z, neutral_point_text(point), comment_line("Flow", point.origin),
      comment_line("Status", point.status));
  for (int c = 0; c < Coefficients::size(); ++c) {
    const std::string coefficient(coefficient_names[static_cast<std::size_t>(c)]);
    out += fmt::format("  <axis name=\"{}\">\n", axis_names[static_cast<std::size_t>(c)]);
    out += function(coefficient + "_0", c, "", point.steady[c]);
    for (const auto& [variable, values] : point.derivatives)
      if (const std::string factors = factors_of(variable, point.freestream); !factors.empty())
        out += function(derivative_name(coefficient, variable), c, factors, values[c].value);
    out += "  </axis>\n";
  }
  return out + "</aerodynamics>\n";
}

}  // namespace alphadot

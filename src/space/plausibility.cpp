#include "space/plausibility.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace alphadot {

namespace {

class Judge {
 public:
  Judge(const Configuration& configuration, std::span<const std::string> patch_names,
        std::span<const BoundaryKind> kinds, const FlightCondition& settings, Real scale,
        const std::string& file)
      : facts_(configuration),
        names_(patch_names),
        kinds_(kinds),
        settings_(settings),
        scale_(scale),
        file_(file) {}

  Findings findings() {
    judge_regions();
    judge_symmetry();
    judge_open_sides();
    if (facts_.has_body) {
      judge_size();
      judge_base();
      judge_far_field();
      judge_motion();
    } else {
      problem("no patch is a \"wall\": all loads are zero",
              "name the surface of the body in [boundary] as \"wall\"");
    }
    judge_jets();
    judge_cells();
    return std::move(out_);
  }

 private:
  void problem(std::string what, std::string remedy) {
    out_.problems.push_back({file_, 0, std::move(what), std::move(remedy)});
  }
  void warn(std::string what) { out_.warnings.push_back(std::move(what)); }

  /// As the mesh file has it.
  std::string text(const Vec3& at) const {
    Vec3 p = (1 / scale_) * at;
    for (int d = 0; d < 3; ++d)
      if (std::abs(at[d]) < 1e-6 * facts_.tolerance) p[d] = 0;  // round-off
    return fmt::format("({:.5g}, {:.5g}, {:.5g})", p.x, p.y, p.z);
  }
  std::string quoted(Index patch) const {
    return fmt::format("\"{}\"", names_[static_cast<std::size_t>(patch)]);
  }

  void judge_regions() {
    std::vector<std::string> listed;
    for (const auto& [region, has_far_field, patches] : facts_.regions) {
      std::vector<std::string> around;
      for (const Index patch : patches) around.push_back(quoted(patch));
      listed.push_back(fmt::format("{} cells from {} to {} inside {}{}", region.cells, text(region.box.lower),
                                   text(region.box.upper), fmt::join(around, ", "),
                                   has_far_field ? "" : " without a far field"));
    }
    if (facts_.region_count > static_cast<GlobalIndex>(listed.size())) listed.emplace_back("...");
    if (facts_.region_count > 1)
      problem(fmt::format("the cells of the mesh form {} regions that share no face: {}", facts_.region_count,
                          fmt::join(listed, "; ")),
              "mesh the flow alone: delete the volumes of the body and of the tools that cut it (in Gmsh "
              "BooleanDifference{...; Delete;}{...; Delete;}, and only the flow in the Physical Volume); "
              "regions that are one flow must share the points of the surface between them");
    else if (!facts_.regions.front().has_far_field)
      problem("no patch is a \"farfield\": nothing drives the flow",
              "name the outer boundary in [boundary] as \"farfield\"");
  }

  static std::string plane_text(const SymmetryPlane& plane, Real offset) {
    for (int d = 0; d < 3; ++d)
      if (std::abs(plane.normal[d]) == 1)
        return fmt::format("the plane {} = {:.5g}", "xyz"[d], plane.normal[d] * offset + 0.0);
    return fmt::format("a plane with the normal ({:.4f}, {:.4f}, {:.4f})", plane.normal.x, plane.normal.y,
                       plane.normal.z);
  }
  std::string text(const SymmetryPlane& plane) const {
    const Real offset = std::abs(plane.offset) <= facts_.tolerance ? 0 : plane.offset / scale_;
    return plane_text(plane, offset);
  }

  bool is_across_y(const SymmetryPlane& plane) const { return std::abs(plane.normal.y) == 1; }
  bool is_middle(const SymmetryPlane& plane) const {
    return is_across_y(plane) && std::abs(plane.offset) <= facts_.tolerance;
  }

  void judge_symmetry() {
    for (const Index patch : facts_.curved_patches)
      problem(fmt::format("the symmetry patch {} is not plane", quoted(patch)),
              "give planes of symmetry patches of their own; a curved wall that does not count in the forces "
              "is a \"sting\"");
    if (settings_.reference.half_model)
      judge_half_model();
    else
      judge_full_model();
  }

  void judge_half_model() {
    const auto middle =
        std::ranges::find_if(facts_.planes, [&](const SymmetryPlane& plane) { return is_middle(plane); });
    if (middle == facts_.planes.end()) {
      problem(fmt::format("reference.model is \"half\", but no symmetry patch lies in the plane y = 0{}",
                          planes_text()),
              remedy_without_middle());
      return;
    }
    if (middle->normal.y > 0) {
      problem("reference.model is \"half\", but the mesh is the half y <= 0",
              "mirror the mesh: the half on the starboard side, y >= 0, is what counts twice");
      return;
    }
    const Real lowest = facts_.domain.lower.y * settings_.reference.length;
    if (lowest < -facts_.tolerance)
      problem(fmt::format(
                  "reference.model is \"half\", but the mesh goes on beyond the plane y = 0, to y = {:.5g}",
                  lowest / scale_),
              "set reference.model = \"full\", or cut the mesh at y = 0");
    for (const auto& plane : facts_.planes)
      if (plane.cuts_body && !is_across_y(plane))
        problem(fmt::format("the body ends in the symmetry patch {} in {}, which is no plane of a half model",
                            quoted(plane.patch), text(plane)),
                "mesh the whole half y >= 0 of the body; a wall of the tunnel that the body stands on is a "
                "\"sting\"");
  }

  std::string planes_text() const {
    std::vector<std::string> listed;
    for (const auto& plane : facts_.planes)
      listed.push_back(fmt::format("{} in {}", quoted(plane.patch), text(plane)));
    return listed.empty() ? "" : fmt::format(" (there is {})", fmt::join(listed, ", "));
  }

  std::string remedy_without_middle() const {
    const auto cutting =
        std::ranges::find_if(facts_.planes, [](const SymmetryPlane& plane) { return plane.cuts_body; });
    if (cutting != facts_.planes.end() && is_across_y(*cutting))
      return "move the mesh along y until its plane of symmetry is y = 0";
    if (cutting != facts_.planes.end())
      return "turn the mesh about the x axis until y points to starboard and z up, with its plane of "
             "symmetry "
             "at y = 0";
    if (facts_.domain.lower.y < 0 && facts_.domain.upper.y > 0)
      return "set reference.model = \"full\" for a mesh on both sides of y = 0";
    return "name the boundary at y = 0 as \"symmetry\" in [boundary]";
  }

  void judge_full_model() {
    for (const auto& plane : facts_.planes) {
      if (plane.cuts_body && !facts_.is_section)
        problem(
            fmt::format("reference.model is \"full\", but the body ends in the symmetry patch {} in {}: "
                        "the loads of its other half are missing",
                        quoted(plane.patch), text(plane)),
            is_middle(plane) && plane.normal.y < 0
                ? "set reference.model = \"half\"; a wall of the tunnel that the body stands on is a "
                  "\"sting\""
                : "turn or move the mesh until the plane of symmetry is y = 0 and the body lies at y >= 0, "
                  "and set reference.model = \"half\"; a wall of the tunnel that the body stands on is a "
                  "\"sting\"");
      else if (!plane.cuts_body && is_middle(plane))
        warn(fmt::format(
            "reference.model is \"full\" beside the symmetry patch {} in the plane y = 0: loads on the "
            "mirror image of the body are not counted",
            quoted(plane.patch)));
    }
  }

  void judge_open_sides() {
    if (facts_.is_section) return;
    for (const auto& [patch, plane] : facts_.open_sides) {
      const auto kind = kinds_[static_cast<std::size_t>(patch)];
      const std::string what =
          fmt::format("the body ends in the \"{}\" {} in {}, a side of the mesh along the stream",
                      word_of(kind), quoted(patch), text(plane));
      if (kind == BoundaryKind::jet)
        problem(what + ": the loads of its other half are missing",
                "name a plane of symmetry \"symmetry\" in [boundary] and set reference.model = \"half\"; a "
                "wall of the "
                "tunnel that the body stands on is a \"sting\"");
      else
        warn(what +
             ": if it is a plane of symmetry, the loads of the other half are missing; name it \"symmetry\" "
             "in [boundary] and set reference.model = \"half\"");
    }
  }

  void judge_jets() {
    for (std::size_t patch = 0; patch < facts_.fore_share.size(); ++patch)
      if (const Real share = facts_.fore_share[patch]; share > plausible::fore_share)
        warn(
            fmt::format("{:.3g} % of the jet \"{}\" looks ahead, into the stream, which it swallows there: a "
                        "jet is for a "
                        "base; the surface of a body is a \"wall\"",
                        100 * share, names_[patch]));
  }

  /// What no vehicle does, and no linear theory is about.
  void judge_motion() {
    const auto& motion = settings_.motion;
    if (motion.kind == MotionKind::none && norm(motion.rotation) == 0) return;
    const bool turns = motion.kind != MotionKind::plunge && motion.kind != MotionKind::sway &&
                       motion.kind != MotionKind::step_alpha && motion.kind != MotionKind::ramp_alpha;
    if (const Real lengths = body_lengths_away(motion.axis_point);
        turns && lengths > plausible::farthest_center)
      warn(fmt::format(
          "motion.axis_point is {:.4g} body lengths away from the body: its turning is mostly a plunge",
          lengths));
    if (motion.kind == MotionKind::none || motion.kind == MotionKind::table ||
        motion.kind == MotionKind::free)
      return;
    if (motion.kind != MotionKind::step_q && motion.amplitude > plausible::largest_amplitude)
      warn(
          fmt::format("motion.amplitude = {:g} degrees: derivatives are about small angles, and beyond {:g} "
                      "degrees loads are "
                      "far from linear",
                      motion.amplitude, plausible::largest_amplitude));
    const bool is_harmonic = motion.kind != MotionKind::step_q && motion.kind != MotionKind::step_alpha &&
                             motion.kind != MotionKind::ramp_alpha;
    if (is_harmonic && motion.reduced_frequency * facts_.body_length > plausible::largest_frequency)
      warn(fmt::format(
          "motion.reduced_frequency = {:g}: in one period the stream passes {:.3g} of the body's length; the "
          "derivatives are those of that frequency, far from the slow motion of a flight",
          motion.reduced_frequency, pi / (motion.reduced_frequency * facts_.body_length)));
  }

  /// Of a point, from the box around the body.
  Real body_lengths_away(const Vec3& point) const {
    Vec3 away;
    for (int d = 0; d < 3; ++d) {
      const Real at = point[d] / settings_.reference.length;
      away[d] = std::max({facts_.body.lower[d] - at, at - facts_.body.upper[d], 0.0});
    }
    return norm(away) / facts_.body_length;
  }

  void judge_size() {
    const auto& reference = settings_.reference;
    const std::string remedy = fmt::format("; check mesh.scale = {:g} and the units of [reference]", scale_);
    if (facts_.body_length < plausible::shortest_body || facts_.body_length > plausible::longest_body)
      warn(fmt::format("the body is {:.4g} reference lengths long{}", facts_.body_length, remedy));
    const auto& seen = facts_.projected_area;
    if (const Real largest = std::max({seen.x, seen.y, seen.z});
        largest * plausible::largest_area < 1 || largest * plausible::smallest_area > 1)
      warn(fmt::format("reference.area is {:.4g} times the body's largest projected area{}", 1 / largest,
                       remedy));
    else if (facts_.is_section && std::abs(1 / seen.z - 1) > plausible::planform_share)
      warn(fmt::format(
          "reference.area is {:.4g} times the planform of the section that the planes of symmetry cut, as "
          "reference.model = \"{}\" counts it: coefficients of a section are per chord times width",
          1 / seen.z, reference.half_model ? "half" : "full"));
    if (const Real lengths = body_lengths_away(reference.moment_center); lengths > plausible::farthest_center)
      warn(fmt::format("reference.moment_center is {:.4g} body lengths away from the body{}", lengths,
                       remedy));
  }

  void judge_base() {
    if (settings_.freestream.mach < plausible::supersonic_mach) return;
    for (std::size_t patch = 0; patch < facts_.aft_area.size(); ++patch)
      if (const Real area = facts_.aft_area[patch]; area > plausible::aft_share * facts_.projected_area.x)
        warn(fmt::format(
            "{:.3g} reference areas of the wall \"{}\" face aft, {:.3g} % of what the walls show to the "
            "stream: inviscid gas does not say how low the pressure on a blunt base is; make it a patch "
            "of its own and a \"jet\", or let the body go on to the outflow as a \"sting\"",
            area, names_[patch], 100 * area / facts_.projected_area.x));
  }

  void judge_far_field() {
    // Round-off where the body ends in the outflow: the last wave arrives with its end.
    if (!(facts_.far_field_ratio < 0.999)) return;
    const Real mach = settings_.freestream.mach;
    if (mach > 1)
      warn(fmt::format(
          "the far field is too near: Mach waves of the body can come back from it {:.3g} of the body's "
          "length behind the nose; move the far field outward, or along the Mach cone of {:.4g} degrees",
          facts_.far_field_ratio, std::asin(1 / mach) / radians_per_degree));
    else
      warn(fmt::format(
          "the far field is too near: {:.4g} body lengths from the body, where Mach {:g} needs {:.3g}",
          facts_.far_field_distance / facts_.body_length, mach,
          needed_far_field_distance(mach, facts_.is_section)));
  }

  void judge_cells() {
    const auto cell_text = [&](const WorstCell& cell) {
      return fmt::format("cell {} at {}", cell.id + 1, text(cell.at));
    };
    const auto& [angle, aspect, ratio] = facts_.quality;
    if (angle.value < plausible::smallest_angle)
      warn(fmt::format("two faces of {} meet at {:.3g} degrees", cell_text(angle), angle.value));
    if (aspect.value > plausible::largest_aspect_ratio)
      warn(fmt::format("{} has an aspect ratio of {:.3g}", cell_text(aspect), aspect.value));
    if (ratio.value > plausible::largest_volume_ratio)
      warn(fmt::format("{} has a neighbour {:.3g} times as large", cell_text(ratio), ratio.value));
  }

  const Configuration& facts_;
  const std::span<const std::string> names_;
  const std::span<const BoundaryKind> kinds_;
  const FlightCondition& settings_;
  Real scale_;
  const std::string& file_;
  Findings out_;
};

}  // namespace

Findings judge(const Configuration& configuration, std::span<const std::string> patch_names,
               std::span<const BoundaryKind> kinds, const FlightCondition& flight, Real scale,
               const std::string& file) {
  return Judge(configuration, patch_names, kinds, flight, scale, file).findings();
}

}  // namespace alphadot

// Which motion, and how it enters the equations.
#pragma once

#include <string>
#include <vector>

#include "core/types.hpp"
#include "core/vec3.hpp"
#include "core/words.hpp"

namespace alphadot {

enum class MotionKind {
  none,
  plunge,
  sway,
  pitch,
  yaw,
  roll,
  flap,
  step_alpha,
  ramp_alpha,
  step_q,
  table,
  free  ///< solved with the flow: see FreedomKind
};

namespace words {
inline constexpr Word<MotionKind> motion[] = {{"none", MotionKind::none},
                                              {"plunge", MotionKind::plunge},
                                              {"sway", MotionKind::sway},
                                              {"pitch", MotionKind::pitch},
                                              {"yaw", MotionKind::yaw},
                                              {"roll", MotionKind::roll},
                                              {"flap", MotionKind::flap},
                                              {"step_alpha", MotionKind::step_alpha},
                                              {"ramp_alpha", MotionKind::ramp_alpha},
                                              {"step_q", MotionKind::step_q},
                                              {"table", MotionKind::table},
                                              {"free", MotionKind::free}};
}
template <>
inline constexpr std::span<const Word<MotionKind>> words_of<MotionKind> = words::motion;

enum class TreatmentKind { field_velocity, rigid_grid, deforming_grid };

namespace words {
inline constexpr Word<TreatmentKind> treatment[] = {{"field_velocity", TreatmentKind::field_velocity},
                                                    {"rigid_grid", TreatmentKind::rigid_grid},
                                                    {"deforming_grid", TreatmentKind::deforming_grid}};
}
template <>
inline constexpr std::span<const Word<TreatmentKind>> words_of<TreatmentKind> = words::treatment;

/// What a body that flies freely may do: move along the axes at rest (surge x, sway y, heave z), turn about
/// its own (roll x, pitch y, yaw z).
enum class FreedomKind { surge, sway, heave, roll, pitch, yaw };

namespace words {
inline constexpr Word<FreedomKind> freedom[] = {{"surge", FreedomKind::surge}, {"sway", FreedomKind::sway},
                                                {"heave", FreedomKind::heave}, {"roll", FreedomKind::roll},
                                                {"pitch", FreedomKind::pitch}, {"yaw", FreedomKind::yaw}};
}
template <>
inline constexpr std::span<const Word<FreedomKind>> words_of<FreedomKind> = words::freedom;

struct MotionSettings {
  MotionKind kind = MotionKind::none;
  TreatmentKind treatment = TreatmentKind::field_velocity;
  Real amplitude = 1;             ///< degrees of alpha, theta or phi; for step_q the reduced rate
  Real reduced_frequency = 0.01;  ///< omega * length / (2 V)
  Vec3 axis_point;                ///< rotations are about this point
  std::string table_file;         ///< for kind = "table"
  /// (p, q, r) * length / (2 V): steady at constant incidence for kind none, at the release for kind free.
  Vec3 rotation{};
};

/// The body of a free flight, as a whole also for a half model; its centre of gravity is motion.axis_point.
struct BodySettings {
  Real mass = 0;    ///< over rho_inf length^3
  Vec3 inertia{};   ///< moments of inertia about the mesh axes through the centre of gravity, over rho_inf
                    ///< length^5
  Vec3 products{};  ///< integrals of x y, x z, y z over the mass, likewise
  Vec3 gravity{};   ///< along the mesh axes at the release, times length / V^2
  std::vector<FreedomKind> free;  ///< all else is held
};

enum class GustKind { none, sharp, one_minus_cosine, harmonic, table };

namespace words {
inline constexpr Word<GustKind> gust[] = {{"none", GustKind::none},
                                          {"sharp", GustKind::sharp},
                                          {"one_minus_cosine", GustKind::one_minus_cosine},
                                          {"harmonic", GustKind::harmonic},
                                          {"table", GustKind::table}};
}
template <>
inline constexpr std::span<const Word<GustKind>> words_of<GustKind> = words::gust;

enum class GustDirection { up, starboard };

namespace words {
inline constexpr Word<GustDirection> gust_direction[] = {{"up", GustDirection::up},
                                                         {"starboard", GustDirection::starboard}};
}
template <>
inline constexpr std::span<const Word<GustDirection>> words_of<GustDirection> = words::gust_direction;

/// Air that moves across the stream, in fronts normal to the mesh's x axis.
struct GustSettings {
  GustKind kind = GustKind::none;
  Real velocity = 0.01;  ///< its largest, over V
  Real length = 1;       ///< of one_minus_cosine, and one wave of harmonic; unit of [reference]
  Real front = 0;        ///< x of its front at t = 0
  Real speed = 1;        ///< at which its pattern comes along x, over the stream's: 0 stands
  GustDirection direction = GustDirection::up;
  std::string table_file;  ///< for kind = "table"
};

}  // namespace alphadot

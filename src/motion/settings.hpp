// Which motion, and how it enters the equations.
#pragma once

#include <string>

#include "core/types.hpp"
#include "core/vec3.hpp"
#include "core/words.hpp"

namespace alphadot {

enum class MotionKind { none, plunge, sway, pitch, yaw, roll, flap, step_alpha, ramp_alpha, step_q, table };

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
                                              {"table", MotionKind::table}};
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

struct MotionSettings {
  MotionKind kind = MotionKind::none;
  TreatmentKind treatment = TreatmentKind::field_velocity;
  Real amplitude = 1;             ///< degrees of alpha, theta or phi; for step_q the reduced rate
  Real reduced_frequency = 0.01;  ///< omega * length / (2 V)
  Vec3 axis_point;                ///< rotations are about this point
  std::string table_file;         ///< for kind = "table"
  Vec3 rotation{};                ///< steady (p, q, r) * length / (2 V) at constant incidence, kind none only
};

}  // namespace alphadot

// What the checkpoints of a run contain: its flow, its limiter, the state of its march, its message.
#pragma once

#include <string>
#include <vector>

#include "app/checkpoints.hpp"
#include "app/run_record.hpp"
#include "derivatives/flow_case.hpp"

namespace alphadot {

class FlowCheckpoint {
 public:
  /// The references must outlive the object.
  FlowCheckpoint(FlowCase& flow, Checkpoints& checkpoints, RunRecord& record)
      : flow_(flow), checkpoints_(checkpoints), record_(record) {}

  /// A head with the loads of the steady state.
  CheckpointHead head(std::string phase) const;
  /// The same with all that the steady march needs to go on.
  CheckpointHead steady_head(std::string phase) const;
  /// Writes a checkpoint of the flow and of `others`, fields that the head belongs to. Collective.
  void save(const CheckpointHead& head, std::vector<CheckpointField> others = {});
  /// Reads the same from the checkpoint that the run begins from. Collective.
  void restore(std::vector<CheckpointField> others = {});
  /// The march goes on from the checkpoint that the run begins from. Collective.
  void restore_march();
  /// The steady state is that of a checkpoint made in the motion.
  void restore_steady();

 private:
  /// Frozen factors of the limiter, or none.
  std::vector<Five<Real>> frozen_factors() const;

  FlowCase& flow_;
  Checkpoints& checkpoints_;
  RunRecord& record_;
};

}  // namespace alphadot

// Expectations: the fields that result.hpp states; JSON as another reader (the library's parser) takes it.
#include "io/result.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "core/error.hpp"
#include "io/temporary_folder.hpp"

namespace alphadot {
namespace {

TEST(Result, HasItsFields) {
  const TemporaryFolder folder;
  Result result;
  result.status = RunStatus::completed;
  result.mesh = {"finner.msh", 100, 30, "abc"};
  result.reference.moment_center = {5.5, 0, 0};
  result.rate = "length / (2 V)";
  result.axes = "body";
  result.forces = {{"CA", 0.1}, {"CN", NAN}};
  result.components["body"] = {{"CA", 0.05}};
  result.excluded = {"base"};
  result.derivatives["Cm_alphadot"] = {-23, 1.5, "harmonic fit"};
  result.performance.wall_s = INFINITY;
  result.performance.iterations = 7;
  result.provenance = provenance(3);
  write_result(folder / "result.json", result);

  std::ifstream stream(folder / "result.json");
  const auto json = nlohmann::json::parse(stream);
  EXPECT_EQ(json["status"], "completed");
  EXPECT_EQ(json["ranks"], 3);
  EXPECT_EQ(json["mesh"]["cells"], 100);
  EXPECT_EQ(json["mesh"]["hash"], "abc");
  EXPECT_EQ(json["reference"]["moment_center"], (std::vector<double>{5.5, 0, 0}));
  EXPECT_EQ(json["reference"]["rate"], "length / (2 V)");
  EXPECT_EQ(json["forces"]["CA"], 0.1);
  EXPECT_TRUE(json["forces"]["CN"].is_null());
  EXPECT_EQ(json["forces"]["components"]["body"]["CA"], 0.05);
  EXPECT_EQ(json["forces"]["excluded"][0], "base");
  EXPECT_EQ(json["derivatives"]["Cm_alphadot"]["value"], -23);
  EXPECT_EQ(json["derivatives"]["Cm_alphadot"]["method"], "harmonic fit");
  EXPECT_TRUE(json["performance"]["wall_s"].is_null());
  EXPECT_TRUE(json["performance"]["halo_fraction"].is_null());
  EXPECT_EQ(json["performance"]["iterations"], 7);
  EXPECT_EQ(json["provenance"]["version"], result.provenance.version);
}

TEST(Result, TextThatIsNotUtf8DoesNotSpoilTheFile) {
  Result result;
  result.mesh.file = "m\xff.msh";
  EXPECT_NO_THROW(nlohmann::json::parse(result_json(result)));
}

TEST(Result, AnUnwritablePathIsAnError) {
  EXPECT_THROW(write_result("/proc/none/result.json", {}), InputError);
}

TEST(Provenance, IsComplete) {
  const Provenance p = provenance(2);
  EXPECT_TRUE(std::regex_match(p.version, std::regex(R"(\d+\.\d+\.\d+)"))) << p.version;
  EXPECT_TRUE(std::regex_match(p.date, std::regex(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ)"))) << p.date;
  EXPECT_TRUE(std::regex_match(p.commit, std::regex("[0-9a-f]{40}(-dirty)?|unknown"))) << p.commit;
  EXPECT_TRUE(std::regex_match(p.hdf5_version, std::regex(R"(\d+\.\d+\.\d+)"))) << p.hdf5_version;
  for (const auto& text : {p.compiler, p.flags, p.build_type, p.mpi_version, p.cpu, p.host})
    EXPECT_NE(text, "");
  EXPECT_EQ(p.ranks, 2);
  EXPECT_NE(version_line().find(p.version), std::string::npos);
}

}  // namespace
}  // namespace alphadot

// particles.vtp as its readers see it: Scree's own, VTK's.
#include <gtest/gtest.h>

#include <fstream>

#include "runtime/render/vtp_reader.h"
#include "runtime/results.h"
#include "tests/runtime/case_text.h"
#include "tests/vtk_reader.h"

namespace scree {
namespace {

// More than the writer's piece, and sizes that are no multiple of three.
std::vector<ParticleState> some_particles(size_t count) {
  std::vector<ParticleState> particles(count);
  for (size_t k = 0; k < count; ++k) {
    const double x = static_cast<double>(k);
    ParticleState& p = particles[k];
    p.id = 7 + k, p.kind = k % 3, p.radius = 1e-4 + 1e-8 * x, p.mass = 1e-9 * x;
    p.position = {1e-3 * x, -2e-3 * x, 0.1}, p.velocity = {x, 0.5, -x}, p.spin = {-1, 2 * x, 0.25};
  }
  return particles;
}

TEST(ParticleFile, ReadsBackAsWritten) {
  for (const size_t count : {0, 1, 2, 20011}) {
    const testing::Folder folder;
    const auto particles = some_particles(count);
    write_particles_vtp(folder.path("particles.vtp"), particles);
    const ParticleFrame frame = read_vtp(folder.path("particles.vtp"));
    ASSERT_EQ(frame.positions.size(), count);
    for (size_t k = 0; k < count; ++k) {
      EXPECT_EQ(frame.positions[k].y, particles[k].position.y);
      EXPECT_EQ(frame.radii[k], static_cast<float>(particles[k].radius));
    }
    for (const auto& field : frame.fields)
      for (size_t k = 0; k < count; ++k) {
        if (field.name == "velocity") {
          EXPECT_EQ(field.values[3 * k + 2], particles[k].velocity.z);
        } else if (field.name == "id") {
          EXPECT_EQ(field.values[k], particles[k].id);
        }
      }
  }
}

TEST(ParticleFile, OpensInVtk) {
  if (!has_vtk_reader()) GTEST_SKIP() << kNoVtkReader;
  const testing::Folder folder;
  const auto particles = some_particles(1001);
  write_particles_vtp(folder.path("particles.vtp"), particles);
  const VtkData data = read_with_vtk({folder.path("particles.vtp")}).front();
  const VtkArray velocity = data.array("point_data", "velocity"), kind = data.array("point_data", "kind");
  ASSERT_EQ(data.points.values.size(), 3 * particles.size());
  EXPECT_EQ(data.cells.size(), particles.size());
  for (size_t k = 0; k < particles.size(); ++k) {
    EXPECT_EQ(data.points.values[3 * k], particles[k].position.x);
    EXPECT_EQ(velocity.values[3 * k + 2], particles[k].velocity.z);
    EXPECT_EQ(kind.values[k], particles[k].kind);
  }
}

// OVITO's reader (its sources, ovito/particles/io and ovito/mesh/io) takes vertices only, one a point, and arrays in
// place in base64 behind a byte count of eight bytes; an appended section is an error to it.
TEST(ParticleFile, IsOfTheKindThatOvitoReads) {
  const testing::Folder folder;
  write_particles_vtp(folder.path("particles.vtp"), some_particles(10));
  std::ifstream file(folder.path("particles.vtp"));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(text.find("header_type=\"UInt64\""), text.npos);
  EXPECT_NE(text.find("NumberOfPoints=\"10\" NumberOfVerts=\"10\""), text.npos);
  EXPECT_EQ(text.find("ppended"), text.npos);
  EXPECT_EQ(text.find("compressor"), text.npos);
  for (size_t at = 0; (at = text.find("<DataArray", at)) != text.npos; ++at)
    EXPECT_NE(text.substr(at, text.find('>', at) - at).find("format=\"binary\""), text.npos);
}

}  // namespace
}  // namespace scree

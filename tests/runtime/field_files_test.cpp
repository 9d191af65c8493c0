// Field files hold what the engine has, read back by VTK's own reader.
#include "runtime/field_files.h"

#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <thread>

#include "geometry/closest_point.h"
#include "runtime/case_error.h"
#include "runtime/particle_fields.h"
#include "runtime/random.h"
#include "runtime/render/quantity.h"
#include "runtime/render/run_pictures.h"
#include "runtime/solid_mesh.h"
#include "tests/runtime/case_text.h"
#include "tests/scenes.h"
#include "tests/vtk_reader.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

// Grains of two kinds in a heap on a floor, with a fibre above it.
Case heap_case(Precision precision = Precision::mixed) {
  Case c = empty_case(1e-5, precision);
  c.domain = {{-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}};
  c.gravity = {0, 0, -9.81};
  add_material(c, {"grain", 2500, 1e7, 0.25});
  add_kind(c, 0, 0.001), add_kind(c, 0, 0.0014);
  c.pairs = {{0, 0, 0.3, 0.5, 0}};
  add_solid(c, floor_at(0, 0.05, 0));
  c.solid.primitives.push_back({Segment{{-0.01, 0, 0.004}, {0.01, 0, 0.004}}, 0.0005, 0, 0});
  c.output.fields.moments.interval = 1e-3;
  c.output.fields.write = particle_field_names();
  return c;
}

std::vector<ParticleState> heap(const Case& c) {
  std::vector<ParticleState> grains;
  for (int k = 0; k < 27; ++k)
    grains.push_back(sphere(c, k % 2,
                            {0.0026 * (k % 3) - 0.003, 0.0026 * (k / 3 % 3) + 0.002, 0.0016 + 0.0027 * (k / 9)},
                            {0.01 * k, 0, -0.1}, {1.0 * k, 2, 3}));
  return grains;
}

// A run as observers see it.
struct Stand {
  explicit Stand(const Case& c) : c(c), engine(make_engine(c)) {}
  RunView view() { return {c, *engine, c.solid, stage, 0, folder_path, log}; }

  testing::Folder folder;
  Case c;
  std::unique_ptr<Engine> engine;
  std::string stage = "settle";
  fs::path folder_path = folder.path("");
  spdlog::logger log{"test"};
};

fs::path frame_path(const Stand& s, const std::string& stem) {
  return s.folder_path / "fields" / fmt::format("{}_{:012}.vtkhdf", stem, s.engine->counters().steps);
}

// By id: what VTK has of a field.
std::map<uint64_t, std::vector<double>> by_id(const VtkData& d, const VtkArray& a) {
  const VtkArray ids = d.array("point_data", "id");
  std::map<uint64_t, std::vector<double>> rows;
  for (size_t k = 0; k < ids.values.size(); ++k)
    rows[static_cast<uint64_t>(ids.values[k])].assign(a.values.begin() + k * a.components,
                                                      a.values.begin() + (k + 1) * a.components);
  return rows;
}

class FieldFilesIn : public ::testing::TestWithParam<Precision> {};

TEST_P(FieldFilesIn, HoldWhatTheEngineHas) {
  if (!has_vtk_reader()) GTEST_SKIP() << kNoVtkReader;
  Stand s(heap_case(GetParam()));
  FieldFiles fields(s.c, s.folder_path, s.engine->dt());
  std::vector<ParticleState> grains = heap(s.c);
  s.engine->insert(std::span(grains).first(20));
  for (int k = 0; k < 900; ++k) s.engine->step();
  for (ParticleState& late : std::span(grains).subspan(20)) late.position.z += 0.01;
  s.engine->insert(std::span(grains).subspan(20));
  for (int k = 0; k < 900; ++k) s.engine->step();
  fields.look(s.view());
  fields.finish(s.view());

  const VtkData d = read_with_vtk({frame_path(s, "particles")})[0];
  EXPECT_EQ(d.class_name, "vtkUnstructuredGrid");
  ASSERT_EQ(d.cells.size(), grains.size());
  for (size_t k = 0; k < d.cells.size(); ++k) EXPECT_EQ(d.cells[k], (std::vector<int64_t>{1, int64_t(k)}));
  EXPECT_NEAR(d.array("field_data", "time").values.at(0), s.engine->time(), 1e-15);

  const std::vector<ParticleState> particles = s.engine->particles();
  const auto sums = s.engine->contact_sums();
  const auto field = [&](const char* name) { return by_id(d, d.array("point_data", name)); };
  const auto position = by_id(d, d.points), velocity = field("velocity"), spin = field("angular_velocity"),
             force = field("force"), stress = field("contact_stress"), radius = field("radius"), kind = field("kind"),
             coordination = field("coordination"), walls = field("wall_contacts"), age = field("age");
  const auto expect_vector = [](const std::vector<double>& found, const Vec3& wanted) {
    EXPECT_FLOAT_EQ(static_cast<float>(found.at(0)), static_cast<float>(wanted.x));
    EXPECT_FLOAT_EQ(static_cast<float>(found.at(1)), static_cast<float>(wanted.y));
    EXPECT_FLOAT_EQ(static_cast<float>(found.at(2)), static_cast<float>(wanted.z));
  };
  int touching = 0;
  for (size_t k = 0; k < particles.size(); ++k) {
    const ParticleState& p = particles[k];
    SCOPED_TRACE(p.id);
    expect_vector(position.at(p.id), p.position);
    expect_vector(velocity.at(p.id), p.velocity);
    expect_vector(spin.at(p.id), p.spin);
    expect_vector(force.at(p.id), sums[k].force);
    EXPECT_EQ(radius.at(p.id)[0], float(p.radius));
    EXPECT_EQ(kind.at(p.id)[0], p.kind);
    EXPECT_EQ(coordination.at(p.id)[0], sums[k].coordination);
    EXPECT_EQ(walls.at(p.id)[0], sums[k].wall_contacts);
    for (int i = 0; i < 6; ++i) EXPECT_EQ(stress.at(p.id)[i], sums[k].stress[i]);
    EXPECT_NEAR(age.at(p.id)[0], p.id < 20 ? 0.018 : 0.009, 1e-8);
    touching += sums[k].coordination + sums[k].wall_contacts;
  }
  EXPECT_GT(touching, 10);
}

INSTANTIATE_TEST_SUITE_P(Each, FieldFilesIn, ::testing::Values(Precision::mixed, Precision::reference),
                         [](const auto& info) { return info.param == Precision::mixed ? "mixed" : "reference"; });

TEST(FieldFiles, ShowTheSolidThatIsThere) {
  if (!has_vtk_reader()) GTEST_SKIP() << kNoVtkReader;
  Stand s(heap_case());
  FieldFiles fields(s.c, s.folder_path, s.engine->dt());
  fields.look(s.view());
  fields.finish(s.view());
  const VtkData d = read_with_vtk({frame_path(s, "solid")})[0];
  const VtkArray primitive = d.array("cell_data", "primitive"), radius = d.array("cell_data", "fibre_radius");
  ASSERT_EQ(primitive.values.size(), d.cells.size());
  ASSERT_GT(d.cells.size(), 50u);
  for (size_t k = 0; k < d.cells.size(); ++k) {
    const Primitive& p = s.c.solid.primitives.at(static_cast<size_t>(primitive.values[k]));
    EXPECT_EQ(radius.values[k], float(p.radius));
    EXPECT_TRUE(d.cells[k][0] == 5 || d.cells[k][0] == 9);
    for (size_t i = 1; i < d.cells[k].size(); ++i) {
      const double* x = &d.points.values.at(3 * static_cast<size_t>(d.cells[k][i]));
      EXPECT_NEAR(distance(p, {x[0], x[1], x[2]}), 0, 1e-8);
    }
  }
}

TEST(FieldFiles, OfNoParticlesAreReadToo) {
  if (!has_vtk_reader()) GTEST_SKIP() << kNoVtkReader;
  Stand s(heap_case());
  FieldFiles fields(s.c, s.folder_path, s.engine->dt());
  s.engine->step();
  fields.look(s.view());
  fields.finish(s.view());
  const VtkData d = read_with_vtk({frame_path(s, "particles")})[0];
  EXPECT_EQ(d.cells.size(), 0u);
}

TEST(FieldFiles, OfManyParticlesKeepEachInItsPlace) {
  if (!has_vtk_reader()) GTEST_SKIP() << kNoVtkReader;
  testing::Folder folder;
  std::vector<float> points, tens;  // several pieces, the last one shorter
  for (int k = 0; k < 150000; ++k) {
    for (int i = 0; i < 3; ++i) points.push_back(float(k) + 0.25f * float(i));
    tens.push_back(10 * float(k));
  }
  const fs::path path = folder.path("many.vtkhdf");
  VtkHdfFile file(path, VtkHdfType::unstructured_grid);
  file.array("Points", std::span<const float>(points), 3);
  const VertexCells cells(tens.size());
  for (const PlainArray& a : cells.arrays()) file.array(packed(a));
  file.array("PointData/tens", std::span<const float>(tens));
  file.close();
  const VtkData d = read_with_vtk({path})[0];
  const VtkArray read = d.array("point_data", "tens");
  EXPECT_EQ(d.points.values, std::vector<double>(points.begin(), points.end()));
  EXPECT_EQ(read.values, std::vector<double>(tens.begin(), tens.end()));
}

// ---- without VTK

std::vector<float> written(const fs::path& path, const std::string& name) {
  Hdf5Reader file(path);
  std::vector<float> values;
  StateReader(file).load("VTKHDF/" + name, values);
  return values;
}

// What the writer packs itself, the library unpacks by its own filters.
TEST(FieldFiles, KeepNoiseAndWhatIsNotToTheBit) {
  testing::Folder folder;
  Random random(3, 1);
  const size_t count = 150001;
  std::vector<float> noise(count), half(count), still(count);
  std::vector<double> wide(count);
  for (size_t k = 0; k < count; ++k) {
    noise[k] = static_cast<float>(random.uniform(-1, 1)), wide[k] = random.uniform(1e-3, 1e3);
    half[k] = random.uniform(0, 1) < 0.5 ? 0 : noise[k];
  }
  const fs::path path = folder.path("noise.vtkhdf");
  {
    VtkHdfFile file(path, VtkHdfType::unstructured_grid);
    file.array("noise", std::span<const float>(noise)), file.array("half", std::span<const float>(half));
    file.array("still", std::span<const float>(still)), file.array("wide", std::span<const double>(wide));
    file.close();
  }
  EXPECT_EQ(written(path, "noise"), noise);
  EXPECT_EQ(written(path, "half"), half);
  EXPECT_EQ(written(path, "still"), still);
  Hdf5Reader file(path);
  std::vector<double> read;
  StateReader(file).load("VTKHDF/wide", read);
  EXPECT_EQ(read, wide);
}

TEST(FieldFiles, SayThatContactsAreUnknownAfterAnInsertion) {
  Stand s(heap_case());
  FieldFiles fields(s.c, s.folder_path, s.engine->dt());
  s.engine->insert(heap(s.c));
  const ParticleSnapshot before(s.c, *s.engine, {"force", "coordination"});
  const auto value = [](const ParticleSnapshot::Column& c, auto like) {
    std::memcpy(&like, c.values.data(), sizeof like);
    return like;
  };
  ASSERT_EQ(before.columns()[4].name, "force");
  EXPECT_TRUE(std::isnan(value(before.columns()[4], 0.0f)));
  EXPECT_EQ(value(before.columns()[5], int16_t{}), -1);
  s.engine->step();
  const ParticleSnapshot after(s.c, *s.engine, {"force", "coordination"});
  EXPECT_FALSE(std::isnan(value(after.columns()[4], 0.0f)));
  EXPECT_GE(value(after.columns()[5], int16_t{}), 0);
}

// At the end of a stage that opens a wall contacts are unknown, and the frame from before it has them.
TEST(FieldFiles, KeepTheFrameOfAStepThatKnowsItsContacts) {
  Stand s(heap_case());
  FieldFiles fields(s.c, s.folder_path, s.engine->dt());
  std::vector<ParticleState> grains = heap(s.c);
  s.engine->insert(std::span(grains).first(20));
  for (int k = 0; k < 50; ++k) s.engine->step();
  fields.look(s.view());
  s.engine->open_walls({});
  fields.look(s.view());
  fields.finish(s.view());
  for (const float f : written(frame_path(s, "particles"), "PointData/age")) EXPECT_NEAR(f, 5e-4, 1e-8);
  EXPECT_EQ(fields.summary()["frames"], 1);
  Hdf5Reader file(frame_path(s, "particles"));
  std::vector<int16_t> coordination;
  StateReader(file).load("VTKHDF/PointData/coordination", coordination);
  EXPECT_EQ(std::ranges::count(coordination, -1), 0);
}

// Frames and their times, as the list of this ending has them.
std::vector<std::pair<std::string, double>> listed(const Stand& s, const std::string& ending) {
  std::vector<std::pair<std::string, double>> frames;
  std::ifstream file(s.folder_path / "fields" / ("particles" + ending));
  if (!file) return frames;
  const nlohmann::json series = nlohmann::json::parse(file);
  for (const auto& f : series["files"]) frames.emplace_back(f["name"], f["time"]);
  return frames;
}

TEST(FieldFiles, AreListedWithTheirTimesUnderBothEndings) {
  Stand s(heap_case());
  FieldFiles fields(s.c, s.folder_path, s.engine->dt());
  s.engine->insert(heap(s.c));
  std::vector<std::pair<std::string, double>> expected;
  for (int frame = 0; frame < 3; ++frame) {
    for (int k = 0; k < 5; ++k) s.engine->step();
    fields.look(s.view());
    expected.emplace_back(frame_path(s, "particles").filename().string(), s.engine->time());
  }
  fields.finish(s.view());
  for (const char* ending : {".vtkhdf.series", ".hdf.series"}) {
    EXPECT_EQ(listed(s, ending), expected) << ending;
    EXPECT_TRUE(fs::exists(s.folder_path / "fields" / (std::string("solid") + ending)));
  }
}

TEST(FieldFiles, AreListedWhileTheRunGoesOn) {
  Stand s(heap_case());
  FieldFiles fields(s.c, s.folder_path, s.engine->dt());
  s.engine->insert(heap(s.c));
  std::vector<std::pair<std::string, double>> looked, known;
  for (int frame = 0; known.size() < 2 && frame < 1200; ++frame) {  // a minute at most
    s.engine->step();
    fields.look(s.view());
    looked.emplace_back(frame_path(s, "particles").filename().string(), s.engine->time());
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    known = listed(s, ".vtkhdf.series");
    ASSERT_LE(known.size(), looked.size());
    EXPECT_TRUE(std::ranges::equal(known, std::span(looked).first(known.size())));
    for (const auto& [name, time] : known) EXPECT_TRUE(fs::exists(s.folder_path / "fields" / name)) << name;
  }
  EXPECT_GE(known.size(), 2u);
}

TEST(FieldFiles, AreWrittenWhileTheNextIsPacked) {
  Stand s(heap_case());
  FieldFiles fields(s.c, s.folder_path, s.engine->dt(), std::chrono::hours{1});
  s.engine->insert(heap(s.c));
  int there_at_once = 0;  // not always: the thread beside may be at a list, for long where it gets no core
  fs::path before;
  for (int frame = 0; there_at_once < 5 && frame < 100; ++frame) {
    s.engine->step();
    fields.look(s.view());
    if (!before.empty()) there_at_once += fs::exists(before);
    before = frame_path(s, "particles");
    EXPECT_FALSE(fs::exists(before));
    std::this_thread::sleep_for(std::chrono::milliseconds(5 * (frame + 1)));
  }
  EXPECT_EQ(there_at_once, 5);
  fields.finish(s.view());
  EXPECT_TRUE(fs::exists(before));
}

TEST(FieldFiles, OfASnapshotAreThoseOfTheMoment) {
  Stand s(heap_case());
  std::vector<ParticleState> grains;  // more than are packed at once, if some are packed after the others; they touch
  const int side = 45, layers = 20;
  const double spacing = 0.00199;
  for (int k = 0; k < side * side * layers; ++k)
    grains.push_back(sphere(
        s.c, 0,
        {spacing * (k % side) - 0.045, spacing * (k / side % side) - 0.045, spacing * (k / side / side) + 0.0065}));
  s.engine->insert(grains);
  s.engine->step();
  const auto names = particle_field_names();
  const auto of_moment = packed_particles(s.c, *s.engine, names);
  const auto of_snapshot = packed_particles(ParticleSnapshot(s.c, *s.engine, names));
  ASSERT_EQ(of_snapshot.size(), of_moment.size());
  for (size_t k = 0; k < of_moment.size(); ++k) {
    EXPECT_EQ(of_snapshot[k].name, of_moment[k].name);
    EXPECT_EQ(of_snapshot[k].size, of_moment[k].size) << of_moment[k].name;
    EXPECT_EQ(of_snapshot[k].pieces, of_moment[k].pieces) << of_moment[k].name;
  }
}

TEST(FieldFiles, OnlyNamedFieldsAreWritten) {
  Stand s(heap_case());
  s.c.output.fields.write = {"age"};
  FieldFiles fields(s.c, s.folder_path, s.engine->dt());
  s.engine->insert(heap(s.c));
  s.engine->step();
  fields.look(s.view());
  fields.finish(s.view());
  Hdf5Reader file(frame_path(s, "particles"));
  for (const char* name : {"age", "id", "radius", "kind"})
    EXPECT_TRUE(file.has(std::string("VTKHDF/PointData/") + name));
  for (const char* name : {"velocity", "force"}) EXPECT_FALSE(file.has(std::string("VTKHDF/PointData/") + name));
}

TEST(FieldFiles, AreReadBackForPictures) {
  Stand s(heap_case());
  FieldFiles fields(s.c, s.folder_path, s.engine->dt());
  s.engine->insert(heap(s.c));
  for (int look = 0; look < 3; ++look) {
    for (int k = 0; k < 100; ++k) s.engine->step();
    fields.look(s.view());
  }
  fields.finish(s.view());
  const std::vector<FrameSource> frames = list_particle_frames(s.folder_path);
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_LT(frames[0].time, frames[1].time);
  EXPECT_NEAR(frames[2].time, s.engine->time(), 1e-12);
  const ParticleFrame frame = read_particle_frame(frames[2]);
  const std::vector<ParticleState> particles = s.engine->particles();
  ASSERT_EQ(frame.count(), particles.size());
  ASSERT_TRUE(frame.find("velocity") && frame.find("contact_stress") && frame.find("kind"));
  EXPECT_EQ(frame.find("id"), nullptr);
  EXPECT_EQ(frame.find("contact_stress")->components, 6);
  for (size_t k = 0; k < particles.size(); ++k) {
    EXPECT_NEAR(frame.positions[k].z, particles[k].position.z, 1e-8);
    EXPECT_EQ(frame.radii[k], static_cast<float>(particles[k].radius));
    EXPECT_EQ(frame.find("velocity")->values[3 * k], static_cast<float>(particles[k].velocity.x));
    EXPECT_EQ(frame.find("kind")->values[k], static_cast<float>(particles[k].kind));
  }
}

// A run's own pictures show the same numbers.
TEST(RunPictures, AreColouredByTheFieldsOfFiles) {
  Stand s(heap_case());
  s.engine->insert(heap(s.c));
  EXPECT_TRUE(std::isnan(values_of(frame_now(s.c, *s.engine, "coordination"), "coordination").at(0)));
  for (int k = 0; k < 100; ++k) s.engine->step();
  const std::vector<ParticleState> particles = s.engine->particles();
  const auto sums = s.engine->contact_sums();
  const auto values = [&](const char* quantity) { return values_of(frame_now(s.c, *s.engine, quantity), quantity); };
  const auto speed = values("speed"), coordination = values("coordination"), walls = values("wall_contacts"),
             kind = values("kind"), age = values("age"), force = values("force_z"), mass = values("mass"),
             diameter = values("diameter");
  ASSERT_EQ(speed.size(), particles.size());
  for (size_t k = 0; k < particles.size(); ++k) {
    const ParticleState& p = particles[k];
    EXPECT_NEAR(speed[k], norm(p.velocity), 1e-6 * norm(p.velocity));
    EXPECT_EQ(coordination[k], sums[k].coordination);
    EXPECT_EQ(walls[k], sums[k].wall_contacts);
    EXPECT_EQ(kind[k], p.kind);
    EXPECT_NEAR(age[k], 100 * s.engine->dt(), 1e-8);
    EXPECT_FLOAT_EQ(force[k], sums[k].force.z);
    EXPECT_FLOAT_EQ(mass[k], p.mass);
    EXPECT_FLOAT_EQ(diameter[k], 2 * p.radius);
  }
  EXPECT_NEAR(frame_now(s.c, *s.engine, "age").positions[0].z, particles[0].position.z, 1e-8);
  EXPECT_THROW(values("temperature"), std::invalid_argument);
  ParticleFrame warm = frame_now(s.c, *s.engine, "kind");  // of files that have it
  warm.fields.push_back({"temperature", 1, std::vector<float>(warm.count(), 300)});
  EXPECT_EQ(values_of(warm, "temperature").at(0), 300);
}

TEST(FieldFiles, OfAnotherOriginAreRefusedByName) {
  const testing::Folder folder;
  const fs::path file = fs::path(folder.path("fields")) / "particles_000000000001.vtkhdf";
  fs::create_directories(file.parent_path());
  std::ofstream(file) << "no HDF5 file";
  try {
    list_particle_frames(folder.path(""));
    FAIL() << "it was taken";
  } catch (const CaseError& e) {
    EXPECT_NE(std::string(e.what()).find("particles_000000000001.vtkhdf"), std::string::npos) << e.what();
  }
}

// A wide domain of small grains: single precision would move them.
TEST(FieldFiles, TakeDoubleWherePositionsNeedIt) {
  Case c = heap_case();
  const auto engine = make_engine(c);
  EXPECT_EQ(ParticleSnapshot(c, *engine, {}).columns()[0].type.size, sizeof(float));
  c.domain.max.x = 20;
  EXPECT_EQ(ParticleSnapshot(c, *engine, {}).columns()[0].type.size, sizeof(double));
}

}  // namespace
}  // namespace scree

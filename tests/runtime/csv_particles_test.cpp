#include "runtime/csv_particles.h"

#include <gtest/gtest.h>

#include <chrono>

#include "tests/runtime/case_text.h"

namespace scree {
namespace {

using testing::Folder;

TEST(CsvParticles, ReadsColumnsInAnyOrder) {
  Folder folder;
  const auto particles = read_particles_csv(
      folder.write("p.csv", "# metres\n\n radius, z, y, x \r\n 1e-3,3,2,1\r\n# more\n+2e-3,-3,-2,-1\n"));
  ASSERT_EQ(particles.size(), 2u);
  EXPECT_EQ(particles[0].position.x, 1);
  EXPECT_EQ(particles[0].position.y, 2);
  EXPECT_EQ(particles[0].position.z, 3);
  EXPECT_EQ(particles[1].radius, 2e-3);
  EXPECT_EQ(particles[1].velocity.x, 0);
  EXPECT_EQ(particles[1].line, 6);
}

TEST(CsvParticles, ReadsVelocitiesAndKinds) {
  Folder folder;
  const auto particles = read_particles_csv(folder.write("p.csv", "x,y,z,r,vx,vy,vz,kind\n0,0,0,1e-3,1,2,3,grain"));
  ASSERT_EQ(particles.size(), 1u);
  EXPECT_EQ(particles[0].velocity.z, 3);
  EXPECT_EQ(particles[0].kind, "grain");
}

TEST(CsvParticles, WrongFilesSayWhere) {
  const std::tuple<const char*, const char*, const char*> wrong[] = {
      {"", ":1:1: ", "the file is empty"},
      {"# only a comment\n", ":1:1: ", "the file is empty"},
      {"x,y,z,r\n", ":1:1: ", "no particles below its header"},
      {"x,y,r\n0,0,1\n", ":1:1: ", "column 'z' is missing, there are: x, y, r"},
      {"x,y,z\n0,0,0\n", ":1:1: ", "column 'radius' is missing"},
      {"x,y,z,radios\n0,0,0,1\n",
       ":1:7: ", "unknown column 'radios', known: x, y, z, radius, r, vx, vy, vz, kind; did you mean 'radius'?"},
      {"x,y,z,r,x\n0,0,0,1,0\n", ":1:9: ", "column 'x' is there twice"},
      {"x,y,z,r,radius\n0,0,0,1,1\n", ":1:9: ", "the radius is there twice"},
      {"x,y,z,r,vx\n0,0,0,1,0\n", ":1:1: ", "column 'vy' is missing"},
      {"1,2,3,4\n", ":1:1: ", "unknown column '1'"},
      {"x,y,z,r\n0,0,0,1e-3\n0,0,0\n", ":3:1: ", "the line has 3 fields, must be 4 like the header: x, y, z, r"},
      {"x,y,z,r\n0,0,0,1e-3,\n", ":2:1: ", "the line has 5 fields"},
      {"x,y,z,r\n0,abc,0,1e-3\n", ":2:3: ", "column 'y': 'abc' is not a number"},
      {"x,y,z,r\n0,,0,1e-3\n", ":2:3: ", "column 'y': '' is not a number"},
      {"x,y,z,r\n0,1.5mm,0,1e-3\n", ":2:3: ", "'1.5mm' is not a number"},
      {"x,y,z,r\n0,0, nan,1e-3\n", ":2:6: ", "column 'z': 'nan' is not a finite number"},
      {"x,y,z,r\ninf,0,0,1e-3\n", ":2:1: ", "column 'x': 'inf' is not a finite number"},
      {"x,y,z,r\n0,0,0,0\n", ":2:7: ", "column 'r': 0 is out of range, must be between 5e-08 and 5 m"},
      {"x,y,z,r\n0,0,0,-1e-3\n", ":2:7: ", "-1e-3 is out of range"},
      {"x,y,z,r\n0,0,0,400\n", ":2:7: ", "400 is out of range"},
      {"x,y,z,r\n0,0,0,1e-999\n", ":2:7: ", "'1e-999' is not a number"},
      {"x,y,z,r\n0,1e9,0,1e-3\n", ":2:3: ", "column 'y': 1e9 is out of range, must be between -1000 and 1000 m"},
      {"x,y,z,r,vx,vy,vz\n0,0,0,1e-3,0,3e8,0\n", ":2:14: ", "column 'vy': 3e8 is out of range"},
  };
  Folder folder;
  for (const auto& [text, place, problem] : wrong) {
    SCOPED_TRACE(text);
    const std::string path = folder.write("p.csv", text);
    try {
      read_particles_csv(path);
      ADD_FAILURE() << "was read";
    } catch (const CaseError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find(path + place), 0u) << message;
      EXPECT_NE(message.find(problem), std::string::npos) << message;
    }
  }
  EXPECT_THROW(read_particles_csv(folder.path("absent.csv")), CaseError);
}

TEST(CsvParticles, ReadsAMillionLinesInSeconds) {
  Folder folder;
  std::string text = "x,y,z,r,vx,vy,vz\n";
  for (int i = 0; i < 1'000'000; ++i)
    text += "-0.0043665959,-0.004916389,0.00057853604,0.0002,2.646e-08,-1.341e-07,-5.754e-07\n";
  const std::string path = folder.write("p.csv", text);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(read_particles_csv(path).size(), 1'000'000u);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  RecordProperty("milliseconds", static_cast<int>(1000 * seconds));
  EXPECT_LT(seconds, 10) << "it takes about 1 s on an idle core";
}

}  // namespace
}  // namespace scree

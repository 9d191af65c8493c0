// What can befall a run from outside: killed, asked to stop, no room on the disk, a second run. Each leaves a state
// that the run goes on from to the bits of one that nothing befell.
#include "tests/cases/faults.h"
#include "runtime/run_folder.h"
#include "tests/cases/small_disk.h"

#include <algorithm>
#include <random>
#include <set>

#include "runtime/render/image.h"

namespace scree {
namespace {

// A run that ends before its first kill, as on a machine quicker than when the undisturbed run was timed, is tried
// again with less time.
TEST_F(Faults, KilledAtAnyMomentTheRunEndsTheSame) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  double longest = 0.8e3 * read_summary(undisturbed())["wall_time_s"].get<double>();  // ms
  const fs::path out = path("killed");
  int kills = 0;
  for (bool done = false; !done;) {
    const std::string threads = std::to_string(1 + kills % 3);
    Process p(run_command(out, {"--resume", "--checkpoint-every", "0.02", "--threads", threads}), path("said"));
    if (kills < 6) {
      std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(random() * 0x1p-32 * longest));
      p.send(SIGKILL);
    }
    const int code = p.wait();
    ASSERT_TRUE(code == 0 || code == -SIGKILL) << code << p.said();
    kills += code == -SIGKILL;
    done = code == 0 && kills > 0;
    if (code == 0 && kills == 0) fs::remove_all(out), longest /= 2;
  }
  RecordProperty("kills", kills);
  expect_undisturbed(out);
}

// Within each kind of stage that takes steps. On a busy machine a signal may come after the stage's end: it is tried
// again. Read and open take no time: what is asked for in them is heeded when the next stage begins.
TEST_F(Faults, AskedToStopInAnyStageTheRunGoesOn) {
  for (const int signal : {SIGTERM, SIGINT})
    for (const std::string stage : {"fall", "pour", "settle", "drain"}) {
      SCOPED_TRACE(fmt::format("{} in {}", strsignal(signal), stage));
      const fs::path out = path("stopped_in_" + stage);
      std::string in;
      for (int attempt = 0; attempt < 20 && in != stage; ++attempt) {
        fs::remove_all(out);
        Process p(run_command(out, {"--checkpoint-every", "1000"}), path("said"));
        wait_until([&] { return text_of(out / "run.log").find("stage '" + stage + "'") != std::string::npos; });
        p.send(signal);
        const int code = p.wait();
        if (code == 0) continue;
        ASSERT_EQ(code, 130) << p.said();
        EXPECT_NE(p.said().find("scree resume"), std::string::npos) << p.said();
        const nlohmann::json summary = read_summary(out);
        EXPECT_EQ(summary["status"], "interrupted");
        in = summary["stages"].back()["name"];
      }
      ASSERT_EQ(in, stage) << "no signal came within the stage";
      expect_resumes(out);
      fs::remove_all(out);
    }
}

// A fill takes no step, but millions take minutes: this one of 12,000 a second. It begins anew.
TEST_F(Faults, AskedToStopWithinAFillTheRunGoesOn) {
  const fs::path whole = path("whole"), out = path("stopped");
  const auto command = [&](const fs::path& folder) {
    std::vector<std::string> a{"run", case_path("olhx/demo.toml"), "--out", folder.string()};
    for (const char* set : {"stage.fill.mass=1.25e-3", "stage.settle.time=2e-4", "stage.drain.max_time=2e-4",
                            "output.fields.stage_ends=false"})
      a.insert(a.end(), {"--set", set});
    return a;
  };
  ASSERT_EQ(execute(command(whole)), 0) << said_;
  Process p(command(out), path("said"));
  wait_until([&] { return text_of(out / "run.log").find("stage 'fill' (fill) begins") != std::string::npos; });
  p.send(SIGTERM);
  ASSERT_EQ(p.wait(), 130) << p.said();
  EXPECT_EQ(read_summary(out)["stages"].back()["name"], "fill");
  EXPECT_EQ(read_summary(out)["particles"], 0);
  ASSERT_EQ(execute({"resume", out.string()}), 0) << said_;
  expect_same_results(out, whole);
}

// Half a checkpoint lies there under a name that nothing takes up.
TEST_F(Faults, KilledWhileItWritesACheckpointTheRunGoesOn) {
  const fs::path out = path("torn");
  const auto half_written = [&] {
    for (const fs::path& file : entries_of(out / "checkpoints"))
      if (file.extension() == ".part") return true;
    return false;
  };
  bool torn = false;
  for (int attempt = 0; attempt < 50 && !torn; ++attempt) {
    fs::remove_all(out);
    Process p(run_command(out, {"--checkpoint-every", "1e-9"}), path("said"));
    wait_until([&] { return !checkpoints_in(out).empty() || fs::exists(out / "summary.json"); });
    const auto give_up = std::chrono::steady_clock::now() + 10s;
    while (!half_written() && !fs::exists(out / "summary.json") && std::chrono::steady_clock::now() < give_up) {
    }
    p.send(SIGKILL);
    torn = p.wait() == -SIGKILL && half_written();
  }
  ASSERT_TRUE(torn) << "no writer was killed";
  expect_resumes(out);
  EXPECT_FALSE(half_written());
}

TEST_F(Faults, ASecondRunInTheFolderIsRefusedAndDoesNotDisturb) {
  const fs::path out = path("shared");
  Process first(run_command(out), path("first_said"));
  wait_until([&] { return fs::exists(out / "mass_flow.csv"); });
  first.send(SIGSTOP);  // so that it is surely still there
  EXPECT_EQ(execute({"resume", out.string()}), 2);
  EXPECT_NE(said_.find("another run (process "), std::string::npos) << said_;
  EXPECT_EQ(execute(run_command(out, {"--resume"})), 2);
  EXPECT_EQ(execute(run_command(out)), 2);
  EXPECT_NE(said_.find("not empty"), std::string::npos) << said_;
  first.send(SIGCONT);
  EXPECT_EQ(first.wait(), 0) << first.said();
  expect_undisturbed(out);
}

// B, of the checkpoints of a run that kept them all, from the first on.
std::vector<uintmax_t> checkpoint_sizes(const fs::path& out) {
  std::set<fs::path> paths;
  for (const fs::path& path : checkpoints_in(out)) paths.insert(path);
  std::vector<uintmax_t> sizes;
  for (const fs::path& path : paths) sizes.push_back(fs::file_size(path));
  return sizes;
}

TEST_F(Faults, AFileBeyondTheLimitStopsTheRunWithAMessage) {
  const fs::path out = path("limited");
  const auto sizes = checkpoint_sizes(undisturbed());
  const uintmax_t limit = (sizes.front() + std::ranges::max(sizes)) / 2;  // the first can be written, the largest not
  const auto limit_files = [&] {
    const rlimit most{limit, limit};
    setrlimit(RLIMIT_FSIZE, &most);
  };
  EXPECT_EQ(execute(run_command(out), limit_files), 3);
  EXPECT_NE(said_.find("cannot write the checkpoint"), std::string::npos) << said_;
  EXPECT_NE(said_.find("File too large"), std::string::npos) << said_;
  expect_resumes(out);
}

TEST_F(Faults, AFullDiskStopsTheRunAndTheEarlierCheckpointIsGood) {
  const fs::path disk = path("disk");
  // Room for the checkpoints at the ends of the first stages, not for all of them.
  const SmallDisk small(disk, std::to_string(std::ranges::max(checkpoint_sizes(undisturbed())) * 5 / 2));
  if (!small.mounted()) return small.try_in_a_namespace();
  const fs::path out = disk / "out";
  const int code = execute(run_command(
      out, {"--checkpoint-every", "0.05", "--set", "checkpoint.keep=1000", "--set", "output.fields.stage_ends=false"}));
  const std::string said = said_;
  EXPECT_EQ(code, 3) << said;
  EXPECT_NE(said.find("No space left on device"), std::string::npos) << said;
  EXPECT_NE(said.find("scree resume"), std::string::npos) << said;
  EXPECT_FALSE(checkpoints_in(out).empty());
  small.grow();
  expect_resumes(out);
}

TEST_F(Faults, AFullDiskUnderTheFieldFilesStopsTheRunWhichGoesOnLater) {
  const fs::path disk = path("disk");
  const SmallDisk small(disk, "1500k");
  if (!small.mounted()) return small.try_in_a_namespace();
  const fs::path out = path("out");  // with room for checkpoints
  fs::create_directories(out);
  fs::create_directory_symlink(disk, out / "fields");
  const std::string often = "output.fields.interval=2e-4";
  const int code = execute(run_command(out, {"--resume", "--set", often}));
  EXPECT_EQ(code, 3) << said_;
  EXPECT_NE(said_.find((out / "fields" / "particles_").string()), std::string::npos) << said_;
  EXPECT_NE(said_.find("No space left on device"), std::string::npos) << said_;
  EXPECT_FALSE(checkpoints_in(out).empty());
  small.grow();
  expect_resumes(out);
  const fs::path whole = path("whole");
  ASSERT_EQ(execute(run_command(whole, {"--set", often})), 0) << said_;
  size_t files = 0;
  for (const auto& entry : fs::directory_iterator(whole / "fields")) {
    ++files;
    EXPECT_EQ(text_of(entry.path()), text_of(disk / entry.path().filename())) << entry.path();
  }
  EXPECT_GT(files, 100u);
  EXPECT_EQ(std::distance(fs::directory_iterator(disk), fs::directory_iterator()), static_cast<long>(files));
}

TEST_F(Faults, AFullDiskUnderItsPicturesStopsTheRunWhichGoesOnLater) {
  const fs::path disk = path("disk");
  const SmallDisk small(disk, "64k");
  if (!small.mounted()) return small.try_in_a_namespace();
  const fs::path picturing = path("picturing.toml"), out = path("out");
  std::ofstream(picturing) << "base = \"" << case_ << "\"\n[[output.picture]]\nname = \"look\"\nsize = \"320x180\"\n"
                           << "samples = 1\ninterval = 2e-3\n";
  fs::create_directories(out);
  fs::create_directory_symlink(disk, out / "pictures");
  EXPECT_EQ(execute({"run", picturing.string(), "--out", out.string(), "--resume"}), 3) << said_;
  EXPECT_NE(said_.find("cannot write " + (out / "pictures" / "look_").string()), std::string::npos) << said_;
  EXPECT_NE(said_.find("No space left on device"), std::string::npos) << said_;
  EXPECT_FALSE(checkpoints_in(out).empty());
  size_t earlier = 0;
  for (const auto& entry : fs::directory_iterator(disk)) {  // each whole
    EXPECT_EQ(read_png(entry.path()).width(), 320) << entry.path();
    ++earlier;
  }
  EXPECT_GT(earlier, 0u);
  EXPECT_EQ(read_summary(out)["status"], "failed");
  EXPECT_GT(fs::file_size(out / "particles.vtp"), 1000u);
  small.grow();
  expect_resumes(out);
  size_t all = 0;
  for (const auto& entry : fs::directory_iterator(disk)) all += read_png(entry.path()).width() == 320;
  EXPECT_GT(all, earlier);
}

// The page is made of results that are there already: the run is done, and says how to try again.
TEST_F(Faults, AReportThatCannotBeWrittenIsAWarning) {
  const fs::path out = path("out");
  fs::create_directories(out / "report.html" / "in_the_way");
  EXPECT_EQ(execute(run_command(out, {"--resume"})), 0) << said_;
  EXPECT_NE(said_.find("scree: warning: no report: "), std::string::npos) << said_;
  EXPECT_NE(said_.find("`scree report " + out.string() + "` tries again"), std::string::npos) << said_;
  EXPECT_EQ(said_.find("report in "), std::string::npos) << said_;
  expect_undisturbed(out);
  fs::remove_all(out / "report.html");
  EXPECT_EQ(execute({"report", out.string()}), 0) << said_;
  EXPECT_TRUE(fs::is_regular_file(out / "report.html"));
}

TEST_F(Faults, NoPlaceForFieldFilesStopsTheRunWithItsName) {
  const fs::path out = path("blocked");
  fs::create_directories(out);
  std::ofstream(out / "fields") << "a file where the folder should be";
  EXPECT_EQ(execute(run_command(out, {"--resume"})), 3);
  EXPECT_NE(said_.find("cannot write " + (out / "fields").string()), std::string::npos) << said_;
  fs::remove(out / "fields");
  fs::remove(out / "summary.json");
  ASSERT_EQ(execute(run_command(out, {"--resume"})), 0) << said_;
  expect_undisturbed(out);
}

// A folder that cannot be written, in a way that holds for root, too.
TEST_F(Faults, NoPlaceForCheckpointsStopsTheRunWithItsName) {
  const fs::path out = path("blocked");
  fs::create_directories(out);
  std::ofstream(out / "checkpoints") << "a file where the folder should be";
  EXPECT_EQ(execute(run_command(out, {"--resume"})), 3);
  EXPECT_NE(said_.find((out / "checkpoints").string()), std::string::npos) << said_;
  fs::remove(out / "checkpoints");
  fs::remove(out / "summary.json");
  ASSERT_EQ(execute(run_command(out, {"--resume"})), 0) << said_;
  expect_undisturbed(out);
}

// Without --out a run goes on in the newest folder of its case, and begins one where there is none.
TEST_F(Faults, ResumeWithoutAFolderTakesTheNewestOfTheCase) {
  const auto here = [&] {
    std::error_code failed;
    fs::current_path(folder_.path(), failed);
  };
  const fs::path first = path("results") / "every_stage", second = path("results") / "every_stage-2";
  ASSERT_EQ(execute({"run", case_, "--resume", "--set", "checkpoint.keep=1000"}, here), 0) << said_;
  expect_undisturbed(first);
  const auto all = checkpoints_in(first);
  const std::string before = text_of(first / "run.log");
  make_died_run(second, all[all.size() / 2]);
  ASSERT_EQ(execute({"run", case_, "--resume"}, here), 0) << said_;
  EXPECT_NE(said_.find("resumed from " + all[all.size() / 2].filename().string()), std::string::npos) << said_;
  expect_undisturbed(second);
  EXPECT_EQ(text_of(first / "run.log"), before);
  EXPECT_FALSE(fs::exists(path("results") / "every_stage-3"));
}

TEST_F(Faults, ResumeTakesTheOptionsOfARun) {
  const fs::path out = path("options");
  ASSERT_EQ(execute(run_command(out, {"--set", "checkpoint.keep=1000"})), 0) << said_;
  while (checkpoints_in(out).size() > 2) fs::remove(checkpoints_in(out).front());
  ASSERT_EQ(execute({"resume", out.string(), "--check-lists", "1", "--force-memory"}), 0) << said_;
  expect_undisturbed(out);
}

TEST_F(Faults, ResumeOfWhatIsNoRunIsBadInput) {
  EXPECT_EQ(execute({"resume", path("nothing").string()}), 2);
  EXPECT_NE(said_.find("case.toml"), std::string::npos) << said_;
}

TEST_F(Faults, NoUsableCheckpointIsBadInput) {
  const fs::path out = path("spoilt");
  ASSERT_EQ(execute(run_command(out)), 0) << said_;
  for (const fs::path& p : checkpoints_in(out)) fs::resize_file(p, fs::file_size(p) / 2);
  EXPECT_EQ(execute({"resume", out.string()}), 2);
  EXPECT_NE(said_.find("truncated"), std::string::npos) << said_;
}

}  // namespace
}  // namespace scree

// Pictures from runs: those a run draws of itself, and those that `scree render` draws from its folder.
#include <cstdlib>
#include <set>

#include "runtime/engine.h"
#include "runtime/render/command.h"
#include "runtime/render/image.h"
#include "runtime/render/particle_frame.h"
#include "runtime/render/run_pictures.h"
#include "runtime/run_folder.h"
#include "tests/cases/every_stage.h"
#include "tests/cases/small_disk.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

const fs::path& finished_run() {
  static const TemporaryFolder folder;
  static const fs::path out = [] {
    RunOptions options;
    options.out = folder.path() / "out";
    EXPECT_EQ(run_case(read_case(write_every_stage(folder.path())), options).status, RunStatus::done);
    return options.out;
  }();
  return out;
}

class Render : public ::testing::Test {
 protected:
  std::vector<fs::path> render(const RenderArguments& arguments) {
    std::vector<fs::path> files;
    render_folder(arguments, [&](const std::string& text) { files.push_back(text); });
    return files;
  }
  std::string refusal(const RenderArguments& arguments) {
    try {
      render(arguments);
    } catch (const std::exception& e) {
      return e.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return "";
  }
  RenderArguments arguments() const {
    RenderArguments a;
    a.folder = finished_run(), a.size = "160x90", a.samples = 1, a.out = (folder_.path() / "pictures").string();
    return a;
  }
  // Does something while `ffmpeg` is a shell script of these commands.
  template <class Do>
  auto with_ffmpeg(const std::string& commands, const Do& something) {
    const fs::path programs = folder_.path() / "programs";
    fs::create_directories(programs);
    std::ofstream(programs / "ffmpeg") << "#!/bin/sh\n" << commands << "\n";
    fs::permissions(programs / "ffmpeg", fs::perms::owner_all);
    const std::string path = getenv("PATH");
    setenv("PATH", (programs.string() + ":" + path).c_str(), 1);
    auto result = something();
    setenv("PATH", path.c_str(), 1);
    return result;
  }
  // A case that draws pictures of itself; `more` goes into its table.
  Case picturing(const std::string& more) {
    const std::string path = (folder_.path() / "picturing.toml").string();
    std::ofstream(path) << "base = \"" << write_every_stage(folder_.path())
                        << "\"\n[[output.picture]]\nname = \"look\"\nsize = \"160x90\"\nsamples = 1\n"
                        << more;
    return read_case(path);
  }
  RunResult run(const Case& c, const fs::path& out) {
    RunOptions options;
    options.out = out;
    return run_case(c, options);
  }

  TemporaryFolder folder_;
};

TEST_F(Render, DrawsEachCameraIntoAFile) {
  RenderArguments a = arguments();
  a.cameras = {"front", "side", "top", "free"};
  a.position = {0.05, -0.1, 0.05}, a.target = {0, 0, 0.02};
  const std::vector<fs::path> files = render(a);
  ASSERT_EQ(files.size(), 4u);
  for (const fs::path& file : files) {
    const Image image = read_png(file);
    EXPECT_EQ(image.width(), 160);
    EXPECT_EQ(image.height(), 90);
    std::set<Srgb> colours;
    for (int y = 0; y < 90; ++y)
      for (int x = 0; x < 160; ++x) colours.insert(image.at(x, y));
    EXPECT_GT(colours.size(), 50u) << file;
  }
}

TEST_F(Render, OneNamedFile) {
  RenderArguments a = arguments();
  a.out = (folder_.path() / "one.png").string(), a.colour = "kind", a.cuts = {"y<"}, a.walls = "hidden";
  EXPECT_EQ(render(a), (std::vector<fs::path>{a.out}));
  EXPECT_EQ(read_png(a.out).width(), 160);
  a.cameras = {"front", "side"};
  EXPECT_NE(refusal(a).find("name a folder"), std::string::npos);
}

TEST_F(Render, WithoutFfmpegAFilmIsItsPictures) {
  RenderArguments a = arguments();
  a.film = true;
  const std::string path = getenv("PATH");
  setenv("PATH", folder_.path().c_str(), 1);
  const std::vector<fs::path> said = render(a);
  setenv("PATH", path.c_str(), 1);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].string().find("ffmpeg cannot be started"), std::string::npos) << said[0];
  const size_t moments = list_particle_frames(a.folder).size();
  EXPECT_GT(moments, 1u);  // field files at the ends of stages
  EXPECT_EQ(entries_of(fs::path(a.out) / "film_front_speed").size(), moments);
}

// A stand-in that notes its arguments and writes its last, the film.
TEST_F(Render, WithFfmpegAFilmIsOneFile) {
  RenderArguments a = arguments();
  a.film = true, a.frames_per_second = 12;
  const std::string noted = (folder_.path() / "arguments").string();
  const std::vector<fs::path> said = with_ffmpeg(
      "printf '%s\\n' \"$@\" > " + noted + "; for film; do :; done; echo film > \"$film\"", [&] { return render(a); });
  const fs::path film = fs::path(a.out) / "film_front_speed.mp4", pictures = fs::path(a.out) / "film_front_speed";
  EXPECT_EQ(said, (std::vector<fs::path>{film}));
  EXPECT_EQ(text_of(film), "film\n");
  const std::string given = "\n" + text_of(noted);
  for (const std::string& expected :
       {std::string("-framerate\n12"), "-i\n" + (pictures / "%05d.png").string(), std::string("-c:v\nlibx264"),
        std::string("-pix_fmt\nyuv420p"), std::string("-y"), std::string("-nostdin")})
    EXPECT_NE(given.find("\n" + expected + "\n"), std::string::npos) << expected << given;
  EXPECT_TRUE(given.ends_with("\n" + film.string() + "\n")) << given;
  // What "%05d.png" names is there, from 0 on.
  const size_t moments = list_particle_frames(a.folder).size();
  for (size_t k = 0; k < moments; ++k) EXPECT_TRUE(fs::exists(pictures / fmt::format("{:05}.png", k))) << k;
}

TEST_F(Render, WhenFfmpegFailsItIsSaidAndThePicturesAreThere) {
  RenderArguments a = arguments();
  a.film = true;
  const std::vector<fs::path> said = with_ffmpeg("exit 7", [&] { return render(a); });
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].string().find("no film: ffmpeg failed with code 7; the pictures are in "), std::string::npos)
      << said[0];
  EXPECT_EQ(entries_of(fs::path(a.out) / "film_front_speed").size(), list_particle_frames(a.folder).size());
  EXPECT_FALSE(fs::exists(fs::path(a.out) / "film_front_speed.mp4"));
}

// In the middle of the picture is the node, metal, with grains behind it and none before it.
TEST_F(Render, TheJunctionCameraShowsANodeOfALattice) {
  const fs::path out = folder_.path() / "lattice";
  RunOptions options;
  options.out = out;
  const Case c = read_case(
      case_path("examples/averages_and_touch.toml"),
      {"stage.fill.count=900", "stage.settle.time=0.003", "stage.drain.max_time=0.004", "output.touch.interval=1e-3",
       "output.average.lattice.spacing=0.5e-3", "output.average.lattice.width=0.8e-3",
       "output.average.filling.spacing=0.5e-3", "output.average.filling.width=0.8e-3"});
  ASSERT_EQ(run_case(c, options).status, RunStatus::done);
  RenderArguments a = arguments();
  a.folder = out, a.cameras = {"junction"}, a.walls = "hidden", a.size = "320x180", a.samples = 4, a.plain = true;
  const std::vector<fs::path> files = render(a);
  ASSERT_EQ(files.size(), 1u);
  EXPECT_TRUE(files[0].filename().string().starts_with("junction_speed")) << files[0];
  const auto shares = [&](const Image& image, int x0, int y0, int x1, int y1) {  // of metal, of grains
    double metal = 0, grains = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const Srgb p = image.at(x, y);
        const int spread = std::max({p[0], p[1], p[2]}) - std::min({p[0], p[1], p[2]});
        metal += spread < 16 && p[0]<235, grains += spread> 40;
      }
    return std::pair{metal / ((x1 - x0) * (y1 - y0)), grains / ((x1 - x0) * (y1 - y0))};
  };
  const Image close = read_png(files[0]);
  EXPECT_GT(shares(close, 155, 85, 165, 95).first, 0.9);
  EXPECT_GT(shares(close, 0, 0, 320, 180).second, 0.1);
  a.point = {-2.5e-3, -2.5e-3, 20e-3};  // above everything
  const Image other = read_png(render(a).at(0));
  EXPECT_LT(shares(other, 155, 85, 165, 95).first, 0.1);
}

TEST_F(Render, AFilmOfOneMomentSaysSo) {
  const fs::path copy = folder_.path() / "copy";
  fs::copy(finished_run(), copy, fs::copy_options::recursive);
  fs::remove_all(copy / "fields");
  RenderArguments a = arguments();
  a.folder = copy, a.film = true;
  EXPECT_NE(render(a).back().string().find("of one moment"), std::string::npos);
}

TEST_F(Render, UnknownNamesAreRefused) {
  RenderArguments a = arguments();
  a.cameras = {"fornt"};
  EXPECT_NE(refusal(a).find("did you mean 'front'?"), std::string::npos) << refusal(a);
  a.cameras.clear(), a.colour = "speeed";
  EXPECT_NE(refusal(a).find("did you mean 'speed'?"), std::string::npos) << refusal(a);
  a.colour = "speed", a.walls = "glass";
  EXPECT_NE(refusal(a).find("known: transparent, faint, hidden"), std::string::npos) << refusal(a);
  a.walls = "faint", a.cuts = {"y"};
  EXPECT_NE(refusal(a).find("'y' is not a cut"), std::string::npos) << refusal(a);
  a.cuts.clear(), a.folder = folder_.path();
  EXPECT_NE(refusal(a).find("no case.toml"), std::string::npos) << refusal(a);
}

TEST_F(Render, ASpoiltParticleFileIsNamed) {
  const fs::path copy = folder_.path() / "copy";
  fs::copy(finished_run(), copy, fs::copy_options::recursive);
  fs::remove_all(copy / "fields");
  fs::resize_file(copy / "particles.vtp", fs::file_size(copy / "particles.vtp") / 2);
  RenderArguments a = arguments();
  a.folder = copy;
  EXPECT_NE(refusal(a).find("is cut off"), std::string::npos) << refusal(a);
  EXPECT_NE(refusal(a).find("particles.vtp"), std::string::npos) << refusal(a);
  fs::remove(copy / "particles.vtp");
  EXPECT_NE(refusal(a).find("no particles"), std::string::npos) << refusal(a);
}

// In a way that holds for root, too.
TEST_F(Render, AFolderThatCannotBeMadeIsNamed) {
  RenderArguments a = arguments();
  std::ofstream(a.out) << "a file where the folder should be";
  EXPECT_NE(refusal(a).find(a.out), std::string::npos) << refusal(a);
  a.out += "/one.png";
  EXPECT_NE(refusal(a).find("cannot make the folder"), std::string::npos) << refusal(a);
}

TEST_F(Render, AFullDiskIsAnErrorThatNamesTheFileAndLeavesNone) {
  const SmallDisk disk(folder_.path() / "disk", "8k");
  if (!disk.mounted()) return disk.try_in_a_namespace();
  RenderArguments a = arguments();
  a.out = (folder_.path() / "disk" / "one.png").string(), a.size = "640x360";
  EXPECT_NE(refusal(a).find("No space left on device"), std::string::npos) << refusal(a);
  EXPECT_NE(refusal(a).find("one.png"), std::string::npos);
  EXPECT_FALSE(fs::exists(a.out));
}

TEST_F(Render, ARunDrawsItselfAtItsMomentsAndEndsInTheSameBits) {
  const Case c = picturing("colour = \"coordination\"\ntimes = [0.002]\nstage_ends = true\n");
  const fs::path out = folder_.path() / "run";
  ASSERT_EQ(run(c, out).status, RunStatus::done);
  expect_same_results(out, finished_run());
  size_t pictures = 0;
  for (const auto& entry : fs::directory_iterator(out / "pictures")) {
    EXPECT_EQ(read_png(entry.path()).height(), 90);
    ++pictures;
  }
  EXPECT_EQ(pictures, 6u);  // at 0.002 s, and at the ends of stages, two of which end at once twice
  EXPECT_GE(read_summary(out)["picture_look"]["pictures"].get<size_t>(), pictures);
}

TEST_F(Render, ARunDrawsEveryQuantityOfItsFields) {
  std::string more = "times = [0.002]\n";
  for (const std::string& quantity : run_quantities())
    more += "[[output.picture]]\nname = \"" + quantity +
            "\"\nsize = \"160x90\"\nsamples = 1\ntimes = [0.002]\ncolour = \"" + quantity + "\"\n";
  const fs::path out = folder_.path() / "run";
  ASSERT_EQ(run(picturing(more), out).status, RunStatus::done);
  std::set<std::string> drawn;  // NAME_TIME.png, at the first step past the moment
  for (const auto& entry : fs::directory_iterator(out / "pictures")) {
    EXPECT_EQ(read_png(entry.path()).width(), 160) << entry.path();
    const std::string file = entry.path().filename().string();
    drawn.insert(file.substr(0, file.rfind('_')));
  }
  for (const char* named : {"speed", "coordination", "kind", "age", "wall_contacts", "mass", "diameter"})
    EXPECT_TRUE(drawn.contains(named)) << named;
  try {
    picturing("colour = \"temperature\"");
    ADD_FAILURE() << "grains have no temperature";
  } catch (const CaseError& e) {
    EXPECT_NE(std::string(e.what()).find("age"), std::string::npos) << e.what();
  }
}

TEST_F(Render, ACaseWithAnUnknownCameraOrQuantityIsRefusedWithItsPlace) {
  const auto said = [&](const std::string& more) {
    try {
      picturing(more);
    } catch (const CaseError& e) {
      return std::string(e.what());
    }
    return std::string("nothing was refused");
  };
  EXPECT_NE(said("camera = \"tpo\"").find("picturing.toml:6"), std::string::npos) << said("camera = \"tpo\"");
  EXPECT_NE(said("camera = \"tpo\"").find("did you mean 'top'?"), std::string::npos);
  EXPECT_NE(said("colour = \"forse\"").find("did you mean 'force'?"), std::string::npos);
  EXPECT_NE(said("cut = \"w<1\"").find("is not a cut"), std::string::npos);
  EXPECT_NE(said("colr = \"speed\"").find("unknown key"), std::string::npos);
}

TEST_F(Render, ARunThatCannotWriteItsPicturesStopsWithACheckpoint) {
  const Case c = picturing("times = [0.02]\n");
  const fs::path out = folder_.path() / "blocked";
  fs::create_directories(out);
  std::ofstream(out / "pictures") << "a file where the folder should be";
  const RunResult result = run(c, out);
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_NE(result.message.find((out / "pictures").string()), std::string::npos) << result.message;
  EXPECT_FALSE(result.checkpoint.empty());
}

}  // namespace
}  // namespace scree

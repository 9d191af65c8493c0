#include "runtime/render/film.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <vector>

extern char** environ;

namespace scree {

namespace {

// Runs a program and waits for it: its exit code; -1 with `why` if it cannot be started.
int execute(const std::vector<std::string>& arguments, std::string& why) {
  std::vector<char*> argv;
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  pid_t process = 0;
  const int error = posix_spawnp(&process, argv[0], nullptr, nullptr, argv.data(), environ);
  if (error) {
    why = std::strerror(error);
    return -1;
  }
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) continue;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

std::string film_frame_name(size_t index) { return fmt::format("{:05}.png", index); }

std::string make_film(const std::filesystem::path& folder, int frames_per_second) {
  const std::filesystem::path film = folder.string() + ".mp4";
  std::string why;
  // yuv420p, the only form that every player has, wants even sides.
  const int code =
      execute({"ffmpeg", "-y", "-loglevel", "error", "-nostdin", "-framerate", std::to_string(frames_per_second), "-i",
               (folder / "%05d.png").string(), "-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-c:v", "libx264", "-crf",
               "18", "-pix_fmt", "yuv420p", film.string()},
              why);
  if (code == 0) return film.string();
  const std::string pictures = fmt::format("the pictures are in {}", folder.string());
  if (code < 0) return fmt::format("no film: ffmpeg cannot be started ({}); {}", why, pictures);
  return fmt::format("no film: ffmpeg failed with code {}; {}", code, pictures);
}

}  // namespace scree

// A film from numbered pictures.
#pragma once

#include <filesystem>
#include <string>

namespace scree {

// The pictures' names in a film's folder: 00000.png, 00001.png, ...
std::string film_frame_name(size_t index);

// Calls ffmpeg to make folder/../NAME.mp4 of folder's pictures. Returns what a user should read: the film's name, or
// why there is none (no ffmpeg, or what it said).
std::string make_film(const std::filesystem::path& folder, int frames_per_second);

}  // namespace scree

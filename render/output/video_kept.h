// What an earlier, killed run has written of a video, as far as it can go on being used. For video_file.cpp.
#pragma once
#include <filesystem>
#include <functional>

#include "render/output/status.h"
#include "render/output/video_libav.h"

namespace shatterbox::render {

// Frames of whole groups, each from one key frame to the next, but no more than `most`: packets are not in
// the order in which frames are shown, and some of the last ones in a group that is cut would be made of
// others that are gone. The last group may lack its end and does not count. 0 for what cannot be read, and
// for .gif, whose frames are made of the ones before them.
long count_whole_groups(const std::filesystem::path& file, long most);

// Hands over the first `count` packets, in the order of the file, as an encoder would give them: their pts in
// frames, H.264 with start codes. The sink returns a code of libav.
Status read_packets(const std::filesystem::path& file, long count, AVRational frame_time,
                    const std::function<int(AVPacket&)>& sink);

}  // namespace shatterbox::render

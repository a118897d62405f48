// The muxer and the encoder of one video, for one thread at a time. For video_file.cpp.
#pragma once
#include <cstdint>
#include <filesystem>

#include "render/output/image.h"
#include "render/output/status.h"
#include "render/output/video_file.h"
#include "render/output/video_libav.h"

namespace shatterbox::render {

struct VideoFormat {
  const char* ending;
  const char* muxer;
  const char* encoder;
  AVPixelFormat pixels;
};
// By extension; nullptr without one that is known.
const VideoFormat* find_format(const std::filesystem::path& path);
Status check_settings(const VideoSettings& settings, const VideoFormat& format);

// Each call returns the first failure.
class VideoStream {
 public:
  Status open(const std::filesystem::path& part, const VideoFormat& format, const VideoSettings& settings);
  // Takes over the first frames of another file of the same format and settings; encode() goes on behind
  // them.
  Status keep(const std::filesystem::path& file, long frames);
  Status encode(const Image& image);
  Status finish();

 private:
  void set_up_encoder(const VideoSettings& settings);
  Status write_header();
  Status convert(const Image& image);
  Status convert_to_yuv(const Image& image);
  Status convert_to_palette(const Image& image);
  Status write_packets();

  const VideoFormat* format_ = nullptr;
  Owned<AVFormatContext> muxer_;
  Owned<AVCodecContext> encoder_;
  Owned<AVFrame> frame_;
  Owned<AVPacket> packet_;
  Owned<SwsContext> scaler_;
  AVStream* stream_ = nullptr;  // the muxer's
  std::int64_t next_pts_ = 0;
};

}  // namespace shatterbox::render

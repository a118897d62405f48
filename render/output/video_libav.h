// What the video files share of FFmpeg's libraries: owners, and codes in words.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

namespace shatterbox::render {

struct Closer {
  void operator()(AVFormatContext* p) const {
    if (p->oformat == nullptr) return avformat_close_input(&p);
    if (p->pb != nullptr) avio_closep(&p->pb);
    avformat_free_context(p);
  }
  void operator()(AVCodecContext* p) const { avcodec_free_context(&p); }
  void operator()(AVFrame* p) const { av_frame_free(&p); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
  void operator()(SwsContext* p) const { sws_freeContext(p); }
};
template <typename T>
using Owned = std::unique_ptr<T, Closer>;

// Opens a file to read packets from. A code of libav, negative where it failed.
inline int open_input(const std::filesystem::path& path, const char* format, Owned<AVFormatContext>& file) {
  AVFormatContext* opened = nullptr;
  const AVInputFormat* const kind = format != nullptr ? av_find_input_format(format) : nullptr;
  const int code = avformat_open_input(&opened, path.c_str(), kind, nullptr);
  if (code < 0) return code;
  file.reset(opened);
  return avformat_find_stream_info(opened, nullptr);
}

inline std::string in_words(int code) {
  char words[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(code, words, sizeof words);
  return words;
}

}  // namespace shatterbox::render

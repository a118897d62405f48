#include "render/output/video_kept.h"

#include <cstdint>
#include <string>

extern "C" {
#include <libavcodec/bsf.h>
#include <libavutil/log.h>
}

namespace shatterbox::render {
namespace {

struct FilterCloser {
  void operator()(AVBSFContext* p) const { av_bsf_free(&p); }
};

/// The file, and the filter that its packets pass; null where they pass none.
struct Source {
  Owned<AVFormatContext> file;
  std::unique_ptr<AVBSFContext, FilterCloser> filter;

  int open(const std::filesystem::path& path) {
    const int code = open_input(path, nullptr, file);
    if (code < 0) return code;
    return file->nb_streams == 1 ? 0 : AVERROR_INVALIDDATA;
  }

  int add_start_codes() {
    const AVCodecParameters& codec = *file->streams[0]->codecpar;
    if (codec.codec_id != AV_CODEC_ID_H264) return 0;
    AVBSFContext* made = nullptr;
    int code = av_bsf_alloc(av_bsf_get_by_name("h264_mp4toannexb"), &made);
    if (code < 0) return code;
    filter.reset(made);
    code = avcodec_parameters_copy(made->par_in, &codec);
    if (code < 0) return code;
    made->time_base_in = file->streams[0]->time_base;
    return av_bsf_init(made);
  }

  /// The next packet; AVERROR_EOF after the last whole one.
  int next(AVPacket& packet) {
    const int code = av_read_frame(file.get(), &packet);
    if (code < 0) return code;
    if ((packet.flags & AV_PKT_FLAG_CORRUPT) != 0) return AVERROR_EOF;  // it was cut short
    if (!filter) return 0;
    const int sent = av_bsf_send_packet(filter.get(), &packet);
    return sent < 0 ? sent : av_bsf_receive_packet(filter.get(), &packet);
  }
};

}  // namespace

long count_whole_groups(const std::filesystem::path& path, long most) {
  av_log_set_level(AV_LOG_QUIET);  // a file that was cut short is what we are here for
  long count = 0, whole = 0;
  Source source;
  const Owned<AVPacket> packet(av_packet_alloc());
  if (source.open(path) >= 0 && source.file->streams[0]->codecpar->codec_id != AV_CODEC_ID_GIF) {
    for (; count <= most && source.next(*packet) >= 0; ++count) {
      if ((packet->flags & AV_PKT_FLAG_KEY) != 0) whole = count;
      av_packet_unref(packet.get());
    }
  }
  av_log_set_level(AV_LOG_ERROR);
  return whole;
}

Status read_packets(const std::filesystem::path& path, long count, AVRational frame_time,
                    const std::function<int(AVPacket&)>& sink) {
  Source source;
  int code = source.open(path);
  if (code >= 0) code = source.add_start_codes();
  const Owned<AVPacket> packet(av_packet_alloc());
  std::int64_t start = AV_NOPTS_VALUE;  // fragments begin late, by as much as the encoder looks ahead
  for (long i = 0; i < count && code >= 0; ++i) {
    code = source.next(*packet);
    if (code < 0) break;
    if (start == AV_NOPTS_VALUE) start = packet->pts;
    packet->pts = av_rescale_q(packet->pts - start, source.file->streams[0]->time_base, frame_time);
    packet->pos = -1;
    code = sink(*packet);
    av_packet_unref(packet.get());
  }
  return code < 0 ? Status{path.string() + ": " + in_words(code)} : Status{};
}

}  // namespace shatterbox::render

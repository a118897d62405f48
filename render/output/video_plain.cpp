#include "render/output/video_plain.h"

#include <cstdint>
#include <system_error>

#include "render/output/video_libav.h"

namespace shatterbox::render {
namespace {

int write_header(AVFormatContext& to) {
  AVDictionary* options = nullptr;
  av_dict_set(&options, "movflags", "faststart", 0);
  const int code = avformat_write_header(&to, &options);
  av_dict_free(&options);
  return code;
}

// Each returns a code of libav, negative where it failed.
int copy_packets(AVFormatContext& from, AVFormatContext& to) {
  const Owned<AVPacket> packet(av_packet_alloc());
  std::int64_t start = AV_NOPTS_VALUE;  // fragments begin late, by as much as the encoder looks ahead
  for (;;) {
    int code = av_read_frame(&from, packet.get());
    if (code == AVERROR_EOF) return 0;
    if (code < 0) return code;
    if (start == AV_NOPTS_VALUE) start = packet->pts;
    packet->pts -= start;
    packet->dts -= start;
    av_packet_rescale_ts(packet.get(), from.streams[0]->time_base, to.streams[0]->time_base);
    packet->pos = -1;
    code = av_write_frame(&to, packet.get());
    av_packet_unref(packet.get());
    if (code < 0) return code;
  }
}

int copy_stream(const std::filesystem::path& fragmented, const std::filesystem::path& plain) {
  Owned<AVFormatContext> from;
  int code = open_input(fragmented, "mp4", from);
  if (code < 0) return code;
  if (from->nb_streams != 1) return AVERROR_INVALIDDATA;
  AVFormatContext* made = nullptr;
  code = avformat_alloc_output_context2(&made, nullptr, "mp4", plain.c_str());
  if (code < 0) return code;
  const Owned<AVFormatContext> to(made);
  to->flags |= AVFMT_FLAG_BITEXACT;
  AVStream* stream = avformat_new_stream(to.get(), nullptr);
  code = avcodec_parameters_copy(stream->codecpar, from->streams[0]->codecpar);
  if (code < 0) return code;
  stream->time_base = from->streams[0]->time_base;
  stream->avg_frame_rate = from->streams[0]->avg_frame_rate;
  code = avio_open(&to->pb, plain.c_str(), AVIO_FLAG_WRITE);
  if (code < 0) return code;
  code = write_header(*to);
  if (code < 0) return code;
  code = copy_packets(*from, *to);
  if (code < 0) return code;
  code = av_write_trailer(to.get());
  if (code < 0) return code;
  return avio_closep(&to->pb);
}

}  // namespace

Status write_plain_mp4(const std::filesystem::path& fragmented, const std::filesystem::path& plain) {
  const int code = copy_stream(fragmented, plain);
  if (code >= 0) return {};
  std::error_code ignored;
  std::filesystem::remove(plain, ignored);
  return {in_words(code)};
}

}  // namespace shatterbox::render

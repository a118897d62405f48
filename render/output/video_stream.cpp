#include "render/output/video_stream.h"

#include <algorithm>
#include <string>

#include "render/output/ending.h"
#include "render/output/palette.h"
#include "render/output/video_kept.h"

extern "C" {
#include <libavutil/opt.h>
}

namespace shatterbox::render {
namespace {

constexpr VideoFormat kFormats[] = {{".mp4", "mp4", "libx264", AV_PIX_FMT_YUV420P},
                                    {".mkv", "matroska", "libx264", AV_PIX_FMT_YUV420P},
                                    {".webm", "webm", "libvpx-vp9", AV_PIX_FMT_YUV420P},
                                    {".gif", "gif", "gif", AV_PIX_FMT_PAL8}};
constexpr int kFramesBetweenKeys = 30;  // what a killed run may lose, beside the encoder's look-ahead

}  // namespace

const VideoFormat* find_format(const std::filesystem::path& path) {
  const std::string ending = lower_case_ending(path);
  for (const VideoFormat& format : kFormats) {
    if (ending == format.ending) return &format;
  }
  return nullptr;
}

Status check_settings(const VideoSettings& s, const VideoFormat& format) {
  if (s.width < 1 || s.height < 1 || s.width > 16384 || s.height > 16384) {
    return {"a video of " + std::to_string(s.width) + " x " + std::to_string(s.height) +
            " pixels is not possible"};
  }
  if (format.pixels == AV_PIX_FMT_YUV420P && (s.width % 2 != 0 || s.height % 2 != 0)) {
    return {"width and height must be even for this kind of video; got " + std::to_string(s.width) + " x " +
            std::to_string(s.height)};
  }
  if (s.frames_per_second < 1) return {"frames per second must be at least 1"};
  return {};
}

Status VideoStream::open(const std::filesystem::path& part, const VideoFormat& format,
                         const VideoSettings& settings) {
  format_ = &format;
  AVFormatContext* muxer = nullptr;
  int code = avformat_alloc_output_context2(&muxer, nullptr, format.muxer, part.c_str());
  muxer_.reset(muxer);
  if (code < 0) return {in_words(code)};
  const AVCodec* codec = avcodec_find_encoder_by_name(format.encoder);
  if (codec == nullptr) return {std::string("this libavcodec has no encoder ") + format.encoder};
  encoder_.reset(avcodec_alloc_context3(codec));
  set_up_encoder(settings);
  code = avcodec_open2(encoder_.get(), codec, nullptr);
  if (code < 0) return {std::string(format.encoder) + ": " + in_words(code)};
  stream_ = avformat_new_stream(muxer_.get(), nullptr);
  avcodec_parameters_from_context(stream_->codecpar, encoder_.get());
  stream_->time_base = encoder_->time_base;
  stream_->avg_frame_rate = encoder_->framerate;
  code = avio_open(&muxer_->pb, part.c_str(), AVIO_FLAG_WRITE);
  if (code < 0) return {in_words(code)};
  return write_header();
}

Status VideoStream::keep(const std::filesystem::path& file, long frames) {
  // The encoder's own time to look ahead: its packets begin that much before their pictures.
  std::int64_t dts = -encoder_->has_b_frames;
  Status status = read_packets(file, frames, encoder_->time_base, [&](AVPacket& packet) {
    packet.dts = dts++;
    packet.duration = 1;
    av_packet_rescale_ts(&packet, encoder_->time_base, stream_->time_base);
    packet.stream_index = stream_->index;
    return av_write_frame(muxer_.get(), &packet);
  });
  next_pts_ = frames;
  if (!status) return status;
  // All of them to the disk, the last fragment too: from here on this file is all there is.
  const int code = av_write_frame(muxer_.get(), nullptr);
  avio_flush(muxer_->pb);
  return code < 0 ? Status{in_words(code)} : Status{};
}

Status VideoStream::encode(const Image& image) {
  if (Status status = convert(image); !status) return status;
  frame_->pts = next_pts_++;
  const int code = avcodec_send_frame(encoder_.get(), frame_.get());
  if (code < 0) return {in_words(code)};
  return write_packets();
}

Status VideoStream::finish() {
  const int code = avcodec_send_frame(encoder_.get(), nullptr);
  if (code < 0) return {in_words(code)};
  if (Status status = write_packets(); !status) return status;
  const int ended = av_write_trailer(muxer_.get());
  if (ended < 0) return {in_words(ended)};
  const int closed = avio_closep(&muxer_->pb);
  return closed < 0 ? Status{in_words(closed)} : Status{};
}

void VideoStream::set_up_encoder(const VideoSettings& settings) {
  AVCodecContext& c = *encoder_;
  c.width = settings.width;
  c.height = settings.height;
  c.pix_fmt = format_->pixels;
  c.time_base = {1, settings.frames_per_second};
  c.framerate = {settings.frames_per_second, 1};
  c.sample_aspect_ratio = {1, 1};
  c.thread_count = 1;  // it has a thread of its own already, and the same file comes out every time
  c.flags |= AV_CODEC_FLAG_BITEXACT;
  muxer_->flags |= AVFMT_FLAG_BITEXACT | AVFMT_FLAG_FLUSH_PACKETS;
  if ((muxer_->oformat->flags & AVFMT_GLOBALHEADER) != 0) c.flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  if (format_->pixels == AV_PIX_FMT_PAL8) return;
  c.gop_size = kFramesBetweenKeys;
  c.color_range = AVCOL_RANGE_MPEG;
  c.colorspace = AVCOL_SPC_BT709;
  c.color_primaries = AVCOL_PRI_BT709;
  c.color_trc = AVCOL_TRC_BT709;
  if (std::string(format_->encoder) == "libx264") {
    av_opt_set(c.priv_data, "preset", settings.preset.c_str(), 0);
    av_opt_set_double(c.priv_data, "crf", settings.crf, 0);
  } else {
    av_opt_set(c.priv_data, "deadline", "realtime", 0);
    av_opt_set_int(c.priv_data, "cpu-used", 7, 0);
    av_opt_set_double(c.priv_data, "crf", std::min(settings.crf + 11.0, 63.0),
                      0);  // about as good as x264's
    c.bit_rate = 0;
  }
}

Status VideoStream::write_header() {
  AVDictionary* options = nullptr;
  if (std::string(format_->muxer) == "mp4") {
    av_dict_set(&options, "movflags", "frag_keyframe+empty_moov+default_base_moof", 0);
  } else if (format_->pixels != AV_PIX_FMT_PAL8) {
    av_dict_set(&options, "cluster_time_limit", "500", 0);
  }
  const int code = avformat_write_header(muxer_.get(), &options);
  av_dict_free(&options);
  return code < 0 ? Status{in_words(code)} : Status{};
}

Status VideoStream::convert(const Image& image) {
  if (!frame_) {
    frame_.reset(av_frame_alloc());
    frame_->format = encoder_->pix_fmt;
    frame_->width = encoder_->width;
    frame_->height = encoder_->height;
    const int code = av_frame_get_buffer(frame_.get(), 0);
    if (code < 0) return {in_words(code)};
  }
  const int code = av_frame_make_writable(frame_.get());
  if (code < 0) return {in_words(code)};
  return format_->pixels == AV_PIX_FMT_PAL8 ? convert_to_palette(image) : convert_to_yuv(image);
}

Status VideoStream::convert_to_yuv(const Image& image) {
  if (!scaler_) {
    const AVPixelFormat source = image.channels == 4 ? AV_PIX_FMT_RGBA : AV_PIX_FMT_RGB24;
    scaler_.reset(sws_getContext(
        image.width, image.height, source, encoder_->width, encoder_->height, encoder_->pix_fmt,
        SWS_BILINEAR | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_BITEXACT, nullptr, nullptr, nullptr));
    if (!scaler_) return {"the picture cannot be converted for the encoder"};
    const int* bt709 = sws_getCoefficients(SWS_CS_ITU709);
    sws_setColorspaceDetails(scaler_.get(), bt709, 1, bt709, 0, 0, 1 << 16, 1 << 16);
  }
  const std::uint8_t* rows[] = {image.pixels.data()};
  const int strides[] = {image.width * image.channels};
  sws_scale(scaler_.get(), rows, strides, 0, image.height, frame_->data, frame_->linesize);
  return {};
}

Status VideoStream::convert_to_palette(const Image& image) {
  const Paletted paletted = find_palette(image);
  for (int y = 0; y < image.height; ++y) {
    std::copy_n(paletted.indices.data() + static_cast<std::ptrdiff_t>(y) * image.width, image.width,
                frame_->data[0] + static_cast<std::ptrdiff_t>(y) * frame_->linesize[0]);
  }
  auto* colours = reinterpret_cast<std::uint32_t*>(frame_->data[1]);
  std::copy(paletted.argb.begin(), paletted.argb.end(), colours);
  return {};
}

Status VideoStream::write_packets() {
  if (!packet_) packet_.reset(av_packet_alloc());
  for (;;) {
    int code = avcodec_receive_packet(encoder_.get(), packet_.get());
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return {};
    if (code < 0) return {in_words(code)};
    packet_->duration = 1;
    av_packet_rescale_ts(packet_.get(), encoder_->time_base, stream_->time_base);
    packet_->stream_index = stream_->index;
    code = av_write_frame(muxer_.get(), packet_.get());
    av_packet_unref(packet_.get());
    if (code < 0) return {in_words(code)};
  }
}

}  // namespace shatterbox::render

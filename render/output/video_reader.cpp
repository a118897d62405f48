#include "render/output/video_reader.h"

#include "render/output/video_libav.h"

extern "C" {
#include <libavutil/log.h>
}

namespace shatterbox::render {

struct VideoReader::Decoder {
  Owned<AVFormatContext> file;
  Owned<AVCodecContext> codec;
  Owned<AVFrame> frame{av_frame_alloc()};
  Owned<AVPacket> packet{av_packet_alloc()};
  Owned<SwsContext> scaler;
  int stream = -1;
  bool is_drained = false;  // the file has no more packets
  Status status;

  int open(const std::filesystem::path& path);
  int feed();
  std::optional<Image> convert();
};

int VideoReader::Decoder::open(const std::filesystem::path& path) {
  int code = open_input(path, nullptr, file);
  if (code < 0) return code;
  const AVCodec* kind = nullptr;
  stream = av_find_best_stream(file.get(), AVMEDIA_TYPE_VIDEO, -1, -1, &kind, 0);
  if (stream < 0) return stream;
  codec.reset(avcodec_alloc_context3(kind));
  code = avcodec_parameters_to_context(codec.get(), file->streams[stream]->codecpar);
  if (code < 0) return code;
  codec->thread_count = 1;
  return avcodec_open2(codec.get(), kind, nullptr);
}

/// One packet more to the decoder, or, after the last one, the word that it was the last.
int VideoReader::Decoder::feed() {
  for (;;) {
    int code = av_read_frame(file.get(), packet.get());
    if (code == AVERROR_EOF) {
      is_drained = true;
      return avcodec_send_packet(codec.get(), nullptr);
    }
    if (code < 0) return code;
    const bool is_ours = packet->stream_index == stream;
    if (is_ours) code = avcodec_send_packet(codec.get(), packet.get());
    av_packet_unref(packet.get());
    if (is_ours || code < 0) return code;
  }
}

std::optional<Image> VideoReader::Decoder::convert() {
  const auto format = static_cast<AVPixelFormat>(frame->format);
  // Bicubic chroma, every value rounded: a picture that was encoded twice comes out the same twice.
  scaler.reset(sws_getCachedContext(
      scaler.release(), frame->width, frame->height, format, frame->width, frame->height, AV_PIX_FMT_RGB24,
      SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_BITEXACT, nullptr, nullptr, nullptr));
  if (!scaler) return std::nullopt;
  const int matrix = frame->colorspace == AVCOL_SPC_BT709 ? SWS_CS_ITU709 : SWS_CS_DEFAULT;
  sws_setColorspaceDetails(scaler.get(), sws_getCoefficients(matrix), frame->color_range == AVCOL_RANGE_JPEG,
                           sws_getCoefficients(SWS_CS_DEFAULT), 1, 0, 1 << 16, 1 << 16);
  Image image(frame->width, frame->height);
  std::uint8_t* const rows[] = {image.pixels.data()};
  const int strides[] = {3 * frame->width};
  sws_scale(scaler.get(), frame->data, frame->linesize, 0, frame->height, rows, strides);
  return image;
}

VideoReader::VideoReader(const std::filesystem::path& path) : decoder_(std::make_unique<Decoder>()) {
  av_log_set_level(AV_LOG_QUIET);  // status() tells what is wrong
  const int code = decoder_->open(path);
  if (code < 0) decoder_->status = {path.string() + ": " + in_words(code)};
}

VideoReader::~VideoReader() = default;

std::optional<Image> VideoReader::next() {
  Decoder& d = *decoder_;
  while (d.status.ok()) {
    int code = avcodec_receive_frame(d.codec.get(), d.frame.get());
    if (code == AVERROR_EOF) return std::nullopt;
    if (code >= 0) {
      auto image = d.convert();
      av_frame_unref(d.frame.get());
      if (!image) d.status = {"its pictures cannot be converted to RGB"};
      return image;
    }
    if (code == AVERROR(EAGAIN) && !d.is_drained) code = d.feed();
    if (code < 0) d.status = {in_words(code)};
  }
  return std::nullopt;
}

Status VideoReader::status() const {
  return decoder_->status;
}

}  // namespace shatterbox::render

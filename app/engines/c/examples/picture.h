/* The samples' functions for pictures: PNG files, and figures that compare two pictures. Images are RGBA, 8 bits. */
#ifndef PICTURE_H
#define PICTURE_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  int width, height;
  const uint8_t *pixels; /* row 0 first, `stride` pixels from row to row */
  int stride;
} Picture;

static double picture_luma(const Picture *p, int x, int y) {
  const uint8_t *c = p->pixels + 4 * ((size_t)y * (size_t)p->stride + (size_t)x);
  return 0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2];
}

/* Peak signal to noise ratio over red, green and blue in decibels. */
static double picture_psnr(const Picture *a, const Picture *b) {
  double squares = 0.0;
  for (int y = 0; y < a->height; ++y)
    for (int x = 0; x < a->width; ++x)
      for (int c = 0; c < 3; ++c) {
        int i = a->pixels[4 * (y * a->stride + x) + c], j = b->pixels[4 * (y * b->stride + x) + c];
        squares += (double)((i - j) * (i - j));
      }
  double mean = squares / (3.0 * a->width * a->height);
  return mean > 0.0 ? 10.0 * log10(255.0 * 255.0 / mean) : INFINITY;
}

/* Structural similarity of luma in windows of 8 x 8 pixels, four pixels apart. */
static double picture_ssim(const Picture *a, const Picture *b) {
  const double c1 = 6.5025, c2 = 58.5225;
  double sum = 0.0;
  int windows = 0;
  for (int y = 0; y + 8 <= a->height; y += 4)
    for (int x = 0; x + 8 <= a->width; x += 4, ++windows) {
      double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
      for (int i = 0; i < 64; ++i) {
        double p = picture_luma(a, x + i % 8, y + i / 8), q = picture_luma(b, x + i % 8, y + i / 8);
        ma += p / 64, mb += q / 64, aa += p * p / 64, bb += q * q / 64, ab += p * q / 64;
      }
      sum += (2 * ma * mb + c1) * (2 * (ab - ma * mb) + c2) /
             ((ma * ma + mb * mb + c1) * (aa - ma * ma + bb - mb * mb + c2));
    }
  return windows ? sum / windows : 1.0;
}

static uint32_t picture_crc(uint32_t crc, const uint8_t *bytes, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  return crc;
}

static void picture_big_endian(uint8_t *to, uint32_t value) {
  for (int i = 0; i < 4; ++i) to[i] = (uint8_t)(value >> (24 - 8 * i));
}

static void picture_chunk(FILE *file, const char *name, const uint8_t *bytes, size_t count) {
  uint8_t number[4];
  picture_big_endian(number, (uint32_t)count);
  fwrite(number, 1, 4, file);
  fwrite(name, 1, 4, file);
  if (count) fwrite(bytes, 1, count, file);
  uint32_t crc = picture_crc(0xffffffffu, (const uint8_t *)name, 4);
  picture_big_endian(number, ~picture_crc(crc, bytes, count));
  fwrite(number, 1, 4, file);
}

/* Writes a PNG without compression, with rows from the bottom if `rows_up` is set. Returns 0 if the file cannot be
 * written. */
static int picture_write(const char *path, const Picture *p, int rows_up) {
  size_t row = 1 + 3 * (size_t)p->width, height = (size_t)p->height;
  /* One stored deflate block per row, with 5 bytes before it. Adler's checksum follows the last one. */
  size_t size = 2 + height * (5 + row) + 4, at = 0;
  uint8_t *data = (uint8_t *)malloc(size), header[13] = {0, 0, 0, 0, 0, 0, 0, 0, 8, 2, 0, 0, 0};
  FILE *file = row < 65536 ? fopen(path, "wb") : NULL;
  if (!data || !file) {
    free(data);
    if (file) fclose(file);
    return 0;
  }
  uint32_t a = 1, b = 0;
  data[at++] = 0x78, data[at++] = 0x01;
  for (size_t y = 0; y < height; ++y) {
    size_t from = rows_up ? height - 1 - y : y;
    data[at++] = y + 1 == height;
    data[at++] = (uint8_t)row, data[at++] = (uint8_t)(row >> 8);
    data[at++] = (uint8_t)~row, data[at++] = (uint8_t)(~row >> 8);
    uint8_t *line = data + at;
    line[0] = 0;
    for (size_t x = 0; x < (size_t)p->width; ++x)
      memcpy(line + 1 + 3 * x, p->pixels + 4 * (from * (size_t)p->stride + x), 3);
    for (size_t i = 0; i < row; ++i) a = (a + line[i]) % 65521, b = (b + a) % 65521;
    at += row;
  }
  picture_big_endian(data + at, b << 16 | a);
  picture_big_endian(header, (uint32_t)p->width);
  picture_big_endian(header + 4, (uint32_t)p->height);
  fwrite("\x89PNG\r\n\x1a\n", 1, 8, file);
  picture_chunk(file, "IHDR", header, sizeof header);
  picture_chunk(file, "IDAT", data, size);
  picture_chunk(file, "IEND", NULL, 0);
  free(data);
  return fclose(file) == 0;
}

#endif

// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Values of Mitsuba 3.9.1's principled plugin, variant scalar_rgb, base colours grey. Its
// directions are named the other way round: its si.wi is wo here.
#pragma once

#include <algorithm>
#include <cmath>

#include <complex>

#include "microfacets.h"

namespace caplet::test {

/// What principled_make makes of parameters: roughness, anisotropy, index, the part that is metal
/// and of the rest the part that is glass.
inline BsdfParameters principled(const std::string& name, float base, float roughness,
                                 float anisotropic = 0, float eta = 1.5f, float metallic = 0,
                                 float spec_trans = 0, float spec_tint = 0, float sheen = 0) {
  BsdfParameters out;
  out.name = name;
  out.kind = material_principled;
  out.reflectance = base;
  out.principled_roughness = roughness;
  const float aspect = std::sqrt(1 - 0.9f * anisotropic);
  out.alpha_u = std::max(roughness * roughness / aspect, CAPLET_ALPHA_SMOOTH);
  out.alpha_v = std::max(roughness * roughness * aspect, CAPLET_ALPHA_SMOOTH);
  out.eta = eta;
  out.principled_metallic = metallic;
  out.principled_transmission = (1 - metallic) * spec_trans;
  out.principled_tint = spec_tint;
  out.principled_normal_tinted = (eta - 1) * (eta - 1) / ((eta + 1) * (eta + 1));
  out.k = sheen;
  out.albedo = 1;
  out.coat_alpha_u = CAPLET_ALPHA_SMOOTH;
  return out;
}

struct PrincipledRow {
  BsdfParameters bsdf;
  Direction wo, wi;
  double value;  // f |cos wi|
};

/// The part of a row's value that its facets have, with Mitsuba's separable masking (its
/// principled.cpp, eval): all of metal and glass; of the rest what the interface reflects, of
/// Fresnel's and the tinted reflectance.
inline double facets_of_mitsuba(const PrincipledRow& row) {
  const BsdfParameters& b = row.bsdf;
  const double metallic = double{b.principled_metallic}, glass = double{b.principled_transmission},
               rest = 1 - metallic - glass;
  if (rest == 0 || row.wi[2] * row.wo[2] < 0) return row.value;
  double length = 0, cos_m = 0;
  for (std::size_t c = 0; c < 3; ++c) length += std::pow(double{row.wo[c]} + double{row.wi[c]}, 2);
  for (std::size_t c = 0; c < 3; ++c)
    cos_m += (double{row.wo[c]} + double{row.wi[c]}) / std::sqrt(length) * double{row.wo[c]};
  const double schlick = std::pow(1 - cos_m, 5), fresnel = metal_reflectance(cos_m, double{b.eta});
  const double tinted =
      double{b.principled_normal_tinted} + (1 - double{b.principled_normal_tinted}) * schlick;
  const double reflectance =
      metallic * (double{b.reflectance} + (1 - double{b.reflectance}) * schlick) + glass * fresnel +
      rest * ((1 - double{b.principled_tint}) * fresnel + double{b.principled_tint} * tinted);
  // The microfacets of a metal that reflects all, without the masking that they have.
  const double lobe = microfacets(row.wo, row.wi, double{b.alpha_u}, double{b.alpha_v}, {0, 1e9});
  return reflectance * lobe /
         correlated_over_separable(row.wo, row.wi, double{b.alpha_u}, double{b.alpha_v});
}

// clang-format off
inline const PrincipledRow principled_rows[] = {
{principled("mitsuba plastic", 0.6f, 0.4f, 0, 1.500f, 0.000f, 0.000f, 0.000f, 0.000f), {0.00303393137f, 0.736797094f, 0.676107109f}, {-0.632398486f, -0.322856218f, 0.70415622f}, 0.1366124},
{principled("mitsuba plastic", 0.6f, 0.4f, 0, 1.500f, 0.000f, 0.000f, 0.000f, 0.000f), {0.0420876853f, 0.937864602f, 0.344439507f}, {-0.71536535f, 0.564754605f, 0.411466449f}, 0.08128236},
{principled("mitsuba plastic", 0.6f, 0.4f, 0, 1.500f, 0.000f, 0.000f, 0.000f, 0.000f), {-0.645706117f, -0.437961519f, 0.625502467f}, {-0.178464711f, -0.962156594f, 0.205924898f}, 0.04162512},
{principled("mitsuba plastic", 0.6f, 0.4f, 0, 1.500f, 0.000f, 0.000f, 0.000f, 0.000f), {0.0619923435f, -0.0739279538f, 0.995334923f}, {-0.974810123f, -0.087766543f, 0.205042139f}, 0.03921541},
{principled("mitsuba rough", 0.5f, 0.9f, 0, 1.500f, 0.000f, 0.000f, 0.000f, 0.000f), {-0.814748049f, -0.254388243f, 0.521029949f}, {-0.51867342f, 0.680309832f, 0.51783818f}, 0.08915059},
{principled("mitsuba rough", 0.5f, 0.9f, 0, 1.500f, 0.000f, 0.000f, 0.000f, 0.000f), {-0.0306782257f, 0.834258556f, 0.550519288f}, {-0.658807755f, 0.651507258f, 0.37617898f}, 0.06955925},
{principled("mitsuba rough", 0.5f, 0.9f, 0, 1.500f, 0.000f, 0.000f, 0.000f, 0.000f), {-0.287041098f, 0.895133674f, 0.341091126f}, {-0.899811029f, 0.0559085682f, 0.432682753f}, 0.0823126},
{principled("mitsuba rough", 0.5f, 0.9f, 0, 1.500f, 0.000f, 0.000f, 0.000f, 0.000f), {0.456806213f, 0.582071185f, 0.672696948f}, {-0.354677647f, 0.288736403f, 0.889289081f}, 0.1468127},
{principled("mitsuba index", 0.3f, 0.3f, 0, 1.900f, 0.000f, 0.000f, 0.000f, 0.000f), {-0.344836056f, -0.072431393f, 0.93586421f}, {0.813490868f, -0.386109114f, 0.434916496f}, 0.0430657},
{principled("mitsuba index", 0.3f, 0.3f, 0, 1.900f, 0.000f, 0.000f, 0.000f, 0.000f), {-0.156160444f, 0.950916886f, 0.267153472f}, {-0.631672621f, 0.733405471f, 0.251209438f}, 0.02488031},
{principled("mitsuba index", 0.3f, 0.3f, 0, 1.900f, 0.000f, 0.000f, 0.000f, 0.000f), {-0.0321821198f, 0.890915453f, 0.453027576f}, {0.87454772f, -0.00448821904f, 0.484918684f}, 0.04610109},
{principled("mitsuba index", 0.3f, 0.3f, 0, 1.900f, 0.000f, 0.000f, 0.000f, 0.000f), {-0.599500179f, 0.161000729f, 0.784014225f}, {-0.906145632f, -0.135555685f, 0.400655389f}, 0.03861399},
{principled("mitsuba metal", 0.7f, 0.5f, 0.800f, 1.500f, 1.000f, 0.000f, 0.000f, 0.000f), {0.0683695227f, 0.935509443f, 0.346623272f}, {-0.759688437f, 0.250091523f, 0.600273013f}, 0.002556262},
{principled("mitsuba metal", 0.7f, 0.5f, 0.800f, 1.500f, 1.000f, 0.000f, 0.000f, 0.000f), {-0.738996863f, 0.293925911f, 0.60621053f}, {0.549814582f, -0.614302814f, 0.565982342f}, 0.05422072},
{principled("mitsuba metal", 0.7f, 0.5f, 0.800f, 1.500f, 1.000f, 0.000f, 0.000f, 0.000f), {-0.108191922f, -0.659946263f, 0.743481994f}, {-0.563962877f, -0.0531772375f, 0.824086189f}, 0.01208083},
{principled("mitsuba metal", 0.7f, 0.5f, 0.800f, 1.500f, 1.000f, 0.000f, 0.000f, 0.000f), {-0.730838358f, -0.343826205f, 0.589625955f}, {0.0165655892f, -0.781057775f, 0.624238968f}, 0.002534495},
{principled("mitsuba glass", 0.9f, 0.5f, 0, 1.500f, 0.000f, 1.000f, 0.000f, 0.000f), {0.833240867f, 0.481959641f, 0.270969748f}, {-0.318597376f, -0.781252563f, 0.536786914f}, 0.008711111},
{principled("mitsuba glass", 0.9f, 0.5f, 0, 1.500f, 0.000f, 1.000f, 0.000f, 0.000f), {0.707892358f, 0.559245825f, -0.431430757f}, {-0.791733682f, 0.382998437f, -0.47588858f}, 0.03398175},
{principled("mitsuba glass", 0.9f, 0.5f, 0, 1.500f, 0.000f, 1.000f, 0.000f, 0.000f), {-0.274406403f, 0.0430189334f, -0.9606511f}, {-0.837905645f, -0.0922639966f, -0.53796047f}, 0.00134203},
{principled("mitsuba glass", 0.9f, 0.5f, 0, 1.500f, 0.000f, 1.000f, 0.000f, 0.000f), {-0.218765125f, -0.144782737f, 0.964976549f}, {0.213674113f, -0.00354925264f, 0.976898551f}, 0.04462597},
{principled("mitsuba glass", 0.9f, 0.5f, 0, 1.500f, 0.000f, 1.000f, 0.000f, 0.000f), {-0.28632611f, -0.200818524f, -0.936850727f}, {0.762687385f, 0.468728185f, 0.445647717f}, 0.03263963},
{principled("mitsuba glass", 0.9f, 0.5f, 0, 1.500f, 0.000f, 1.000f, 0.000f, 0.000f), {0.820728421f, 0.109417908f, -0.560742855f}, {-0.784660995f, -0.0473048985f, 0.618117571f}, 0.3662227},
{principled("mitsuba tint", 0.4f, 0.5f, 0, 1.500f, 0.000f, 0.000f, 0.600f, 0.000f), {-0.235655978f, -0.185225755f, 0.954021871f}, {0.187957346f, -0.734524727f, 0.652031839f}, 0.08553229},
{principled("mitsuba tint", 0.4f, 0.5f, 0, 1.500f, 0.000f, 0.000f, 0.600f, 0.000f), {0.671954036f, -0.475453943f, 0.567821503f}, {0.928183079f, 0.157904133f, 0.336960584f}, 0.04569311},
{principled("mitsuba tint", 0.4f, 0.5f, 0, 1.500f, 0.000f, 0.000f, 0.600f, 0.000f), {0.952414811f, -0.0959748775f, 0.28930065f}, {-0.674859703f, 0.0207994245f, 0.737652898f}, 0.1495122},
{principled("mitsuba tint", 0.4f, 0.5f, 0, 1.500f, 0.000f, 0.000f, 0.600f, 0.000f), {0.602100611f, -0.591117561f, 0.536707461f}, {-0.81598407f, 0.473026007f, 0.332289606f}, 0.08495834},
{principled("mitsuba sheen", 0.3f, 0.6f, 0, 1.500f, 0.000f, 0.000f, 0.000f, 1.000f), {0.453815728f, 0.627943695f, 0.632248342f}, {-0.177294075f, 0.911725461f, 0.370571852f}, 0.03835763},
{principled("mitsuba sheen", 0.3f, 0.6f, 0, 1.500f, 0.000f, 0.000f, 0.000f, 1.000f), {0.248545766f, 0.923493505f, 0.292206764f}, {0.0322403945f, -0.97402966f, 0.22411336f}, 0.09392837},
{principled("mitsuba sheen", 0.3f, 0.6f, 0, 1.500f, 0.000f, 0.000f, 0.000f, 1.000f), {-0.763236523f, -0.552441657f, 0.335079432f}, {0.380478591f, -0.0807784572f, 0.921255052f}, 0.1006537},
{principled("mitsuba sheen", 0.3f, 0.6f, 0, 1.500f, 0.000f, 0.000f, 0.000f, 1.000f), {-0.370580077f, -0.677333772f, 0.635522902f}, {0.941396952f, 0.0904526487f, 0.324946284f}, 0.03621249},
{principled("mitsuba all", 0.4f, 0.6f, 0.500f, 1.500f, 0.300f, 0.300f, 0.000f, 0.000f), {0.107489154f, 0.497507542f, 0.860774279f}, {-0.877045572f, 0.196111158f, 0.438556075f}, 0.03349192},
{principled("mitsuba all", 0.4f, 0.6f, 0.500f, 1.500f, 0.300f, 0.300f, 0.000f, 0.000f), {0.0951207504f, -0.970331728f, 0.222279951f}, {0.51251775f, -0.652134955f, 0.55861038f}, 0.0435936},
{principled("mitsuba all", 0.4f, 0.6f, 0.500f, 1.500f, 0.300f, 0.300f, 0.000f, 0.000f), {-0.611268044f, -0.225054339f, 0.75875026f}, {-0.82474649f, -0.0308123808f, 0.564662576f}, 0.04756936},
{principled("mitsuba all", 0.4f, 0.6f, 0.500f, 1.500f, 0.300f, 0.300f, 0.000f, 0.000f), {0.864693165f, -0.450057387f, 0.223056301f}, {-0.231299892f, -0.767348051f, 0.598061323f}, 0.04329878},
{principled("mitsuba all", 0.4f, 0.6f, 0.500f, 1.500f, 0.300f, 0.300f, 0.000f, 0.000f), {-0.680952609f, -0.442448378f, 0.583560646f}, {0.508820713f, 0.558830857f, -0.654835522f}, 0.02015454},
{principled("mitsuba all", 0.4f, 0.6f, 0.500f, 1.500f, 0.300f, 0.300f, 0.000f, 0.000f), {-0.0744596794f, -0.0830857232f, 0.993756771f}, {-0.0512622036f, -0.0299134813f, 0.998237133f}, 0.1444723},
};
// clang-format on

}  // namespace caplet::test

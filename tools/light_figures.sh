#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
#
# The figures of docs/lights.md: each light in a corner with a ball. light_figures.sh CAPLET [SAMPLES]
set -eu
caplet=$1 samples=${2:-256} pictures=lights
. "$(dirname "$0")/figures.sh"

# A sky of four colours, square: its upper half is the diamond within.
printf 'P3 4 4 255\n40 40 40 90 140 230 90 140 230 40 40 40 90 140 230 250 220 160 250 220 160 90 140 230 90 140 230 250 220 160 250 220 160 90 140 230 40 40 40 90 140 230 90 140 230 40 40 40\n' > "$folder/sky.ppm"
cat > "$folder/lamp.ies" <<END
IESNA:LM-63-2002
[TEST] none: made for a figure
TILT=NONE
1 1000 1 7 3 1 2 0 0 0
1 1 10
0 10 20 30 45 60 90
0 45 90
900 800 300 500 200 40 0
900 700 200 100 100 20 0
900 600 100 50 20 10 0
END

# figure NAME LIGHTS SHAPES
figure() {
  rendered "$1" <<END
LookAt 0 -7 2.2  0 0 1  0 0 1
Camera "perspective" "float fov" 32
Film "rgb" "integer xresolution" 192 "integer yresolution" 144
Sampler "zsobol" "integer pixelsamples" $samples
WorldBegin
$2
Material "diffuse" "rgb reflectance" [0.6 0.6 0.6]
Shape "disk" "float radius" 20
Shape "bilinearmesh" "point3 P" [-9 2 0  9 2 0  -9 2 9  9 2 9]
$3
Translate 0.8 0 0.7
Shape "sphere" "float radius" 0.7
END
}

figure point 'LightSource "point" "point3 from" [-1 -1 2.5] "float power" 200' ''
figure spot 'LightSource "spot" "point3 from" [-1.5 -2 3] "point3 to" [0.3 0.5 0.8] "float coneangle" 22 "float power" 60' ''
figure goniometric 'AttributeBegin Translate -1 -0.5 1.8 LightSource "goniometric" "string filename" "tiles.ppm" "float power" 200 AttributeEnd' ''
figure projection 'AttributeBegin Translate 0 -4 1.4 Rotate -90 1 0 0 Scale 1 -1 1 LightSource "projection" "string filename" "tiles.ppm" "float fov" 38 "float power" 60 AttributeEnd' ''
figure ies 'AttributeBegin Translate -0.6 1.6 2.6 LightSource "ies" "string filename" "lamp.ies" "float power" 90 AttributeEnd' ''
figure distant 'LightSource "distant" "point3 from" [-2 -3 4] "point3 to" [0 0 0] "float illuminance" 3' ''
figure constant 'LightSource "infinite" "float illuminance" 3' ''
figure image 'LightSource "infinite" "string filename" "sky.ppm" "float illuminance" 3' ''
figure portal 'LightSource "infinite" "string filename" "sky.ppm" "float illuminance" 60 "point3 portal" [-3 0.6 0.8  -3 0.6 2.2  -3 -1 2.2  -3 -1 0.8]' ''
figure area 'AttributeBegin AreaLightSource "diffuse" "string filename" "tiles.ppm" "float scale" 2 "bool twosided" true Material "diffuse" "rgb reflectance" [0 0 0] Shape "bilinearmesh" "point3 P" [-2 0.6 0.3  -0.2 1.4 0.3  -2 0.6 2.1  -0.2 1.4 2.1] AttributeEnd' ''

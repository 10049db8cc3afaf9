// yoro 0.1.0, synthesis passes, written from its GLSL by `cargo xtask maintain renew`. Do not edit.
// SPDX-License-Identifier: MIT OR Apache-2.0
export const precisions = 'precision highp float;precision highp int;precision highp sampler2D;precision highp usampler2D;';
export const screenVertex = /* glsl */`${precisions}
void main(){int id=gl_VertexID;vec2 corner=vec2(float((id<<1)&2),float(id&2));gl_Position=vec4(corner*2.0-1.0,0.0,1.0);}`;
export const marchVertex = /* glsl */`${precisions}
uniform ivec2 target_size;
uniform ivec2 target_origin;
uniform vec4 span_place;
out vec2 span_at;
void main(){int id=gl_VertexID;vec2 corner=vec2(float((id<<1)&2),float(id&2));vec2 pixel=vec2(target_origin)+corner*vec2(target_size);span_at=span_place.xy*pixel+span_place.zw;gl_Position=vec4(corner*2.0-1.0,0.0,1.0);}`;
export const guessedDepth = /* glsl */`${precisions}
const bool PART=false;
uniform ivec2 source_size;
uniform vec2 law;
uniform ivec2 source_origin;
uniform sampler2D depth_map;
uniform sampler2D color_map;
const float NEARER=0.5;
const float SHARE=0.15;
const ivec2 BESIDE[4]=ivec2[4](ivec2(-1,0),ivec2(1,0),ivec2(0,-1),ivec2(0,1));
ivec2 place(ivec2 pixel){ivec2 first=PART?source_origin:ivec2(0);return clamp(pixel,first,first+source_size-1);}
float moves(ivec2 pixel){return law.y*texelFetch(depth_map,(place(pixel)),0).r;}
vec3 shown(ivec2 pixel){return texelFetch(color_map,(place(pixel)),0).rgb;}
void main(){ivec2 pixel=ivec2(gl_FragCoord.xy);float behind=moves(pixel)+NEARER;float nearest=behind;ivec2 to=ivec2(0);for(int i=0;i<4;++i){float beside=moves(pixel+BESIDE[i]);to=beside>nearest?BESIDE[i]:to;nearest=max(nearest,beside);}gl_FragDepth=texelFetch(depth_map,(place(pixel)),0).r;if(to!=ivec2(0)){vec3 front=shown(pixel+(moves(pixel+2*to)>behind?2:1)*to);vec3 here=shown(pixel);vec3 back=moves(pixel-to)>behind?here:shown(pixel-to);vec3 contrast=front-back;if(dot(here-back,contrast)>SHARE*max(dot(contrast,contrast),1e-4)){gl_FragDepth=texelFetch(depth_map,(place(pixel+to)),0).r;}}}`;
export const tiles = /* glsl */`${precisions}
const bool PART=false;
uniform ivec2 source_size;
uniform vec2 law;
uniform bool mirrored;
uniform float far_displacement;
uniform vec2 columns;
uniform ivec2 source_origin;
uniform vec2 texel;
const ivec2 TILE=ivec2(16,8);
uniform sampler2D depth_map;
float nearest_of(vec4 texel){return texel.r;}
float depth_sample(vec2 place){return nearest_of(textureLod(depth_map,(place),0.0));}
vec4 depth_gather(vec2 place){ivec2 last=textureSize(depth_map,0).xy-1;ivec2 corner=ivec2(floor(place*vec2(last+1)-0.5));ivec2 low=clamp(corner,ivec2(0),last);ivec2 high=clamp(corner+1,ivec2(0),last);return vec4(nearest_of(texelFetch(depth_map,(ivec2(low.x,high.y)),0)),nearest_of(texelFetch(depth_map,(high),0)),nearest_of(texelFetch(depth_map,(ivec2(high.x,low.y)),0)),nearest_of(texelFetch(depth_map,(low),0)));}
float displacement(float depth){return law.x+law.y*depth;}
vec2 place_of(vec2 at){at=PART?clamp(at,vec2(0.5),vec2(source_size)-0.5):at;return vec2(columns.x*at.x+columns.y,(float(source_origin.y)+at.y)*texel.y);}
const float TILE_UNITS=16.0;
vec4 depth_quad(vec2 corner){vec2 last=vec2(source_size-2);vec2 at=PART?clamp(corner,vec2(0.0),max(last,vec2(0.0))):corner;float row=at.y+1.0;row=PART?(float(source_origin.y)+row)*texel.y:row/float(source_size.y);vec4 quad=depth_gather(vec2(columns.x*(at.x+1.0)+columns.y,row));return quad;}
uint pack_interval(float low,float high){float lowest=clamp(floor((low-far_displacement)*TILE_UNITS),0.0,65534.0);float highest=clamp(ceil((high-far_displacement)*TILE_UNITS),0.0,65535.0);return uint(lowest)|(uint(highest)<<16);}
uint reversed_bits(uint bits){bits=bits>>16|bits<<16;bits=(bits&0xff00ff00u)>>8|(bits&0x00ff00ffu)<<8;bits=(bits&0xf0f0f0f0u)>>4|(bits&0x0f0f0f0fu)<<4;bits=(bits&0xccccccccu)>>2|(bits&0x33333333u)<<2;return(bits&0xaaaaaaaau)>>1|(bits&0x55555555u)<<1;}
const float PLANAR=1.0/16.0;
const float NO_PLANE=9.0;
const float MARKED=0.99;
uint in_place(uint marks){return mirrored?marks>>16|marks<<16:reversed_bits(marks);}
uvec4 plane_tile(vec2 corner){const vec2 LAST=vec2(TILE.x,TILE.y-1);vec2 middle=corner+0.5;float first=depth_sample(place_of(middle));float right=depth_sample(place_of(middle+vec2(LAST.x,0.0)));float above=depth_sample(place_of(middle+vec2(0.0,LAST.y)));float opposite=depth_sample(place_of(middle+LAST));vec2 slope=(vec2(right,above)-first)/LAST;slope=abs(law.y*(first-right-above+opposite))<=4.0*PLANAR?slope:vec2(0.0);vec4 low=vec4(1e9);vec4 high=vec4(-1e9);float plane=0.0;uint lower_marks=0u;uint marks=0u;float marked=MARKED/abs(law.y);float begin=mirrored?LAST.x-1.0:0.0;float sense=mirrored?-1.0:1.0;for(float row=corner.y;row<corner.y+float(TILE.y);row+=2.0){lower_marks=row==corner.y+4.0?marks:lower_marks;vec2 before=vec2(0.0);for(int i=0;i<=TILE.x;i+=2){float column=begin+sense*float(min(i,TILE.x-1));vec4 quad=depth_quad(vec2(corner.x+column,row));vec4 depths=quad-(plane+slope.x*column);low=min(low,depths);high=max(high,depths);vec2 between=abs(quad.xw-before);vec2 within=abs(quad.yz-quad.xw);before=quad.yz;if(i>0&&i<TILE.x){marks=marks<<1|uint(max(between.x,between.y)>marked);}marks=marks<<1|uint(max(within.x,within.y)>marked);}plane+=2.0*slope.y;}vec4 second=slope.x*(mirrored?vec4(1,0,0,1):vec4(0,1,1,0))+slope.y*vec4(1,1,0,0);low-=second;high-=second;low.xy=min(low.xy,low.zw);high.xy=max(high.xy,high.zw);float least=min(low.x,low.y);float most=max(high.x,high.y);vec2 rise=slope*LAST;float a=displacement(least+min(rise.x,0.0)+min(rise.y,0.0));float b=displacement(most+max(rise.x,0.0)+max(rise.y,0.0));vec3 plane_law=vec3(displacement(0.5*(least+most)),law.y*slope);bool planar=abs(law.y)*(most-least)<=2.0*PLANAR&&abs(plane_law.y-0.25)<0.75;uvec3 rest=planar?floatBitsToUint(plane_law):uvec3(in_place(lower_marks),floatBitsToUint(NO_PLANE),in_place(marks));return uvec4(pack_interval(min(a,b),max(a,b)),rest);}
layout(location=0)out uvec4 tile;
void main(){tile=plane_tile((gl_FragCoord.xy-0.5)*vec2(TILE));}`;
export const spans = /* glsl */`${precisions}
uniform ivec2 source_size;
uniform ivec2 target_size;
uniform vec2 law;
uniform int row_offset;
uniform float far_displacement;
uniform float near_displacement;
uniform vec2 columns;
uniform vec2 origins;
uniform vec2 rows;
uniform float first_row;
const ivec2 TILE=ivec2(16,8);
const float TILE_UNITS=16.0;
const uint SPAN_COLUMNS=0x3ffu;
uint pack_span(float reach,float columns){return((floatBitsToUint(reach)+SPAN_COLUMNS)&~SPAN_COLUMNS)|min(uint(columns),SPAN_COLUMNS);}
uniform highp usampler2D tile_map;
const float PLANAR=1.0/16.0;
const float NO_PLANE=9.0;
const int LAW_TILES=4;
vec3 landing(int source_tile,int row){vec3 plane=uintBitsToFloat(texelFetch(tile_map,ivec2(source_tile,row),0).yzw);float first=float(source_tile*TILE.x)+plane.x;return vec3(first,first+float(TILE.y-1)*plane.z,plane.y);}
bool repeats_border(int row){int rows=(source_size.y+TILE.y-1)/TILE.y;return(row==0&&row_offset>0)||(row==rows-1&&target_size.y-row_offset>source_size.y);}
vec3 tile_plane(ivec2 tile,int left,int right){if(left>right||right>=left+LAW_TILES||repeats_border(tile.y)){return vec3(0.0);}float first=float(tile.x*TILE.x);float last=first+float(TILE.x-1);vec4 ends=vec2(first,last).xyxy;vec4 corners=vec4(0.0);bool planar=true;for(int s=left;s<=right;++s){vec3 lands=landing(s,tile.y);planar=planar&&lands.z<NO_PLANE;vec4 place=float(s*TILE.x)+(ends-lands.xxyy)/(1.0+lands.z);corners=mix(corners,place,s==left?bvec4(true):lessThanEqual(lands.xxyy,ends));}vec2 slope=vec2(corners.y-corners.x,corners.z-corners.x)/vec2(TILE.x-1,TILE.y-1);float error=abs(corners.w-corners.y-corners.z+corners.x);for(int s=left+1;s<=right;++s){vec2 lands=landing(s,tile.y).xy;vec2 off=abs(corners.xz+slope.x*(lands-first)-float(s*TILE.x));bvec2 inside=lessThan(abs(lands-0.5*(first+last)),vec2(0.5*(last-first)));error=max(error,max(inside.x?off.x:0.0,inside.y?off.y:0.0));}vec4 middle=vec4(0.5*float(source_size.x-1));if(!planar||!(error<=PLANAR)||any(greaterThan(abs(corners-middle),middle))){return vec3(0.0);}float column=corners.x+slope.x*(origins.y+law.x-first)-slope.y*(first_row+0.5+float(tile.y*TILE.y));return vec3(columns.x*(column+0.5)+columns.y,columns.x*slope*vec2(origins.x,1.0));}
layout(location=0)out uvec4 span;
void main(){ivec2 tile=ivec2(gl_FragCoord.xy);float first=float(tile.x*TILE.x);float last=first+float(TILE.x-1);int tiles=(source_size.x+TILE.x-1)/TILE.x;int from=clamp(int(floor((first-near_displacement-1.0)/float(TILE.x)))-1,0,tiles-1);int to=clamp(int(floor((last-far_displacement+1.0)/float(TILE.x))),0,tiles-1);const int PITCH=TILE.x*int(TILE_UNITS);int least=int(floor((first-1.0-far_displacement-float((from+1)*TILE.x))*TILE_UNITS));int most=int(ceil((last+1.0-far_displacement-float(from*TILE.x))*TILE_UNITS));int low=0xffff;int high=0;int left=tiles;int right=0;for(int s=from;s<=to;++s){uint moved=texelFetch(tile_map,ivec2(s,tile.y),0).r;int lowest=max(int(moved&0xffffu),least);int highest=min(int(moved>>16),most);if(lowest<=highest){low=min(low,lowest);high=max(high,highest);left=min(left,s);right=s;}least-=PITCH;most-=PITCH;}if(high<low){low=high=2*tile.x*TILE.x<target_size.x?0xffff:0;}uint search=pack_span(float(high)/TILE_UNITS,ceil(float(high-low)/TILE_UNITS)+2.0);span=uvec4(search,0u,0u,0u);vec3 affine=tile_plane(tile,left,right);if(affine.y!=0.0){span.xyz=floatBitsToUint(affine);}}`;
export const march = /* glsl */`${precisions}
const bool PART=false;
uniform ivec2 source_size;
uniform vec2 law;
uniform bool mirrored;
uniform vec2 columns;
uniform vec2 origins;
uniform vec2 rows;
uniform float first_row;
uniform float farthest;
uniform ivec2 source_origin;
uniform vec2 texel;
const float MAX_STRETCH=2.0;
const ivec2 TILE=ivec2(16,8);
uniform sampler2D depth_map;
uniform sampler2D color_map;
float nearest_of(vec4 texel){return texel.r;}
float depth_sample(vec2 place){return nearest_of(textureLod(depth_map,(place),0.0));}
vec4 color_sample(vec2 place){return textureLod(color_map,(place),0.0);}
vec4 depth_gather(vec2 place){ivec2 last=textureSize(depth_map,0).xy-1;ivec2 corner=ivec2(floor(place*vec2(last+1)-0.5));ivec2 low=clamp(corner,ivec2(0),last);ivec2 high=clamp(corner+1,ivec2(0),last);return vec4(nearest_of(texelFetch(depth_map,(ivec2(low.x,high.y)),0)),nearest_of(texelFetch(depth_map,(high),0)),nearest_of(texelFetch(depth_map,(ivec2(high.x,low.y)),0)),nearest_of(texelFetch(depth_map,(low),0)));}
vec2 place_of(vec2 at){at=PART?clamp(at,vec2(0.5),vec2(source_size)-0.5):at;return vec2(columns.x*at.x+columns.y,(float(source_origin.y)+at.y)*texel.y);}
float column_at(float x){return place_of(vec2(x+0.5,0.5)).x;}
float row_at(float away){return PART?place_of(vec2(0.5,gl_FragCoord.y-first_row+away)).y:rows.x*(gl_FragCoord.y+away)+rows.y;}
const uint SPAN_COLUMNS=0x3ffu;
float span_steps(uint span){uint steps=span&SPAN_COLUMNS;return steps==SPAN_COLUMNS?1e9:float(steps);}
uniform highp usampler2D span_map;
in vec2 span_at;
uvec4 pixel_span(){return texture(span_map,span_at);}
float lowest_bit(uint bits){float power=float(bits&(~bits+1u));return float(floatBitsToUint(power)>>23)-127.0;}
const float NO_PLANE=9.0;
uniform highp usampler2D tile_map;
struct Surface{float source;float depth;bool hole;};
struct Edge{float x;float depth;};
vec4 tap_beside(Edge edge,float distance,out float nearer){vec2 place=vec2(column_at(edge.x),row_at(distance));nearer=law.y*(depth_sample(place)-edge.depth);return color_sample(place);}
vec4 fill_hole(Edge edge,vec4 color,float away){float spread=0.5*clamp(abs(away),1.0,12.0);vec4 sum=2.0*color;float weights=2.0;for(int i=1;i<=2;++i){float distance=roundEven(float(i)*spread);vec2 nearer;vec4 below=tap_beside(edge,-distance,nearer.x);vec4 above=tap_beside(edge,distance,nearer.y);vec2 weight=vec2(lessThanEqual(nearer,vec2(1.0)));sum+=weight.x*below+weight.y*above;weights+=weight.x+weight.y;}return sum/weights;}
struct Search{float x;vec2 depths;float a;float b;};
vec2 depth_pair(float x){vec4 quad=depth_gather(vec2(columns.x*(x+1.25)+columns.y,row_at(0.25)));return mirrored?quad.zw:quad.wz;}
Search search_at(float x,float origin){vec2 depths=depth_pair(x);float shift=x-origin;return Search(x,depths,shift+law.y*depths.x,shift+1.0+law.y*depths.y);}
bool is_event(float a,float b){return a<=0.0&&(b>0.0||max(b,-1.0)<a);}
float segment_end(float x,int tile_row,bool below,uint shift){uint column=uint(x);uint within=column%uint(TILE.x);uvec4 tile=texelFetch(tile_map,ivec2(column/uint(TILE.x),tile_row),0);uint marks=(below?tile.y:tile.w)>>(shift+within);marks=tile.z==floatBitsToUint(NO_PLANE)?marks:0u;return x+lowest_bit(marks|0x10000u>>within);}
struct Beside{float edge;float edge_depth;float rim;float rim_depth;};
bool meet(inout Beside beside,Search at){bool jump=at.b>0.0;bool torn=at.b-at.a>=MAX_STRETCH;bool rim=beside.rim<0.0&&(!jump||(torn&&at.b<1.0));beside.rim=rim?at.x+(jump?1.0:0.0):beside.rim;beside.rim_depth=rim?(jump?at.depths.y:at.depths.x):beside.rim_depth;bool farther=jump&&law.y*(at.depths.x-beside.edge_depth)<0.0;beside.edge=farther?at.x:beside.edge;beside.edge_depth=farther?at.depths.x:beside.edge_depth;return jump&&(at.a>-0.5||!torn);}
vec4 march(Search at,float end,float origin,int row,out Surface surface){float border=at.a-at.x;bool outside=at.x<=0.0&&border>0.0;end=outside&&border<0.5?0.0:end;Beside beside;beside.edge=outside?0.0:-1.0;beside.edge_depth=outside?at.depths.x:law.y<0.0?-1e9:1e9;beside.rim=-1.0;beside.rim_depth=0.0;bool found=false;if(at.x>=0.0&&at.x<end&&is_event(at.a,at.b)){found=meet(beside,at);}float x=max(at.x+1.0,0.0);float a=at.b+(x-at.x-1.0);int tile_row=row/TILE.y;bool below=(row&4)==0;uint shift=uint(row&2)<<3;bool crosses=false;while(x<=end&&!found){at=search_at(min(segment_end(x,tile_row,below,shift),end),origin);crosses=a<=0.0&&at.a>0.0;found=crosses;if(!crosses&&at.x<end&&is_event(at.a,at.b)){found=meet(beside,at);}x=found?x:at.x+1.0;a=found?a:at.b;}float last=at.x;float b=at.a;while(crosses&&x<last){at=search_at(clamp(floor(x+(last-x)*a/(a-b)),x,last-1.0),origin);crosses=at.a>0.0||at.b<=0.0;bool behind=at.a>0.0;x=behind?x:at.x+1.0;a=behind?a:at.b;last=behind?at.x:last;b=behind?at.a:b;}bool own=found||beside.edge<0.0;x=own?min(at.x,end):beside.edge;float t=found&&at.b-at.a<MAX_STRETCH?-at.a/(at.b-at.a):0.0;surface.source=x+t;surface.depth=own?mix(at.depths.x,at.depths.y,t):beside.edge_depth;float away=x-origin+law.y*surface.depth;surface.hole=!found&&abs(away)>=0.5;vec4 color=color_sample(vec2(column_at(surface.source),row_at(0.0)));if(surface.hole){color=fill_hole(Edge(x,surface.depth),color,away);}if(beside.rim>=0.0){float coverage=1.0-abs(beside.rim-origin+law.y*beside.rim_depth);color=mix(color,color_sample(vec2(column_at(beside.rim),row_at(0.0))),coverage);if(coverage>=0.5){surface=Surface(beside.rim,beside.rim_depth,false);}}return color;}
layout(location=0)out vec4 color;
int source_row(){return int(clamp(gl_FragCoord.y-first_row,0.0,float(source_size.y-1)));}
const float FIRST_STEPS=2.0;
vec4 sample_planar(vec3 affine,out Surface surface){float place=affine.x+affine.y*gl_FragCoord.x+affine.z*gl_FragCoord.y;surface.source=clamp((place-columns.y)/columns.x-0.5,0.0,float(source_size.x-1));surface.depth=(origins.x*gl_FragCoord.x+origins.y-surface.source)/law.y;if(law.y==0.0){vec2 depths=depth_pair(floor(surface.source));surface.depth=mix(depths.x,depths.y,fract(surface.source));}surface.hole=false;vec2 at=vec2(place,row_at(0.0));return color_sample(at);}
vec4 searched(uint span,out Surface surface){float origin=origins.x*gl_FragCoord.x+origins.y;Search at=search_at(floor(origin-farthest-uintBitsToFloat(span)),origin);float end=min(max(at.x,0.0)+span_steps(span),float(source_size.x-1));float limit=min(at.x+FIRST_STEPS,end);for(;at.x<limit&&at.b<=0.0&&max(at.b,-1.0)>=at.a;at.x+=1.0){float next=depth_sample(vec2(column_at(at.x+2.0),row_at(0.0)));at.depths=vec2(at.depths.y,next);at.a=at.b;at.b=at.x+2.0-origin+law.y*next;}float stretch=at.b-at.a;float t=-at.a/stretch;surface=Surface(at.x+t,mix(at.depths.x,at.depths.y,t),false);vec4 seen=color_sample(vec2(column_at(surface.source),row_at(0.0)));float middle=0.5*float(source_size.x-1);bool done=at.a<=0.0&&at.b>0.0&&stretch<MAX_STRETCH&&abs(surface.source-middle)<=middle;if(!done){seen=march(at,end,origin,source_row(),surface);}return seen;}
void main(){uvec4 span=pixel_span();Surface surface;if(span.y!=0u){color=sample_planar(uintBitsToFloat(span.xyz),surface);}else{color=searched(span.x,surface);}gl_FragDepth=surface.depth;}`;
export const nearFraction = /* glsl */`${precisions}
uniform highp sampler2D depth_map;
float depth_of(ivec2 p){return texelFetch(depth_map,p,0).x;}
uniform ivec2 origin;
uniform ivec2 size;
uniform float near_depth;
uniform bool reversed;
layout(location=0)out vec4 fraction;
const int GRID=16;
const int SAMPLES=8;
void main(){ivec2 cell=ivec2(gl_FragCoord.xy)*SAMPLES;float count=0.0;for(int j=0;j<SAMPLES;++j){for(int i=0;i<SAMPLES;++i){ivec2 pixel=origin+((cell+ivec2(i,j))*2+1)*size/(2*GRID*SAMPLES);float depth=depth_of(pixel);count+=(reversed?depth>near_depth:depth<near_depth)?1.0:0.0;}}fraction=vec4(count/float(SAMPLES*SAMPLES));}`;

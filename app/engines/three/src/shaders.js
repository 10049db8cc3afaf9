// yoro 0.1.0, synthesis passes, written from its GLSL by `cargo xtask maintain renew`. Do not edit.
// SPDX-License-Identifier: MIT OR Apache-2.0
export const precisions = 'precision highp float;precision highp int;precision highp sampler2D;precision highp usampler2D;';
export const screenVertex = /* glsl */`${precisions}
void main(){int a=gl_VertexID;vec2 b=vec2(float((a<<1)&2),float(a&2));gl_Position=vec4(b*2.0-1.0,0.0,1.0);}`;
export const marchVertex = /* glsl */`${precisions}
uniform ivec2 target_size;
uniform ivec2 target_origin;
uniform vec4 span_place;
out vec2 span_at;
void main(){int a=gl_VertexID;vec2 b=vec2(float((a<<1)&2),float(a&2));vec2 c=vec2(target_origin)+b*vec2(target_size);span_at=span_place.xy*c+span_place.zw;gl_Position=vec4(b*2.0-1.0,0.0,1.0);}`;
export const guessedDepth = /* glsl */`${precisions}
uniform ivec2 source_size;
uniform vec2 law;
uniform sampler2D depth_map;
uniform sampler2D color_map;
const ivec2 Y[4]=ivec2[4](ivec2(-1,0),ivec2(1,0),ivec2(0,-1),ivec2(0,1));
ivec2 S(ivec2 a){ivec2 b=ivec2(0);return clamp(a,b,b+source_size-1);}
float R(ivec2 a){return law.y*texelFetch(depth_map,(S(a)),0).r;}
vec3 X(ivec2 a){return texelFetch(color_map,(S(a)),0).rgb;}
void main(){ivec2 a=ivec2(gl_FragCoord.xy);float b=R(a)+0.5;float c=b;ivec2 d=ivec2(0);for(int e=0;e<4;++e){float f=R(a+Y[e]);d=f>c?Y[e]:d;c=max(c,f);}gl_FragDepth=texelFetch(depth_map,(S(a)),0).r;if(d!=ivec2(0)){vec3 g=X(a+(R(a+2*d)>b?2:1)*d);vec3 h=X(a);vec3 i=R(a-d)>b?h:X(a-d);vec3 j=g-i;if(dot(h-i,j)>0.15*max(dot(j,j),1e-4)){gl_FragDepth=texelFetch(depth_map,(S(a+d)),0).r;}}}`;
export const tiles = /* glsl */`${precisions}
uniform ivec2 source_size;
uniform vec2 law;
uniform bool mirrored;
uniform float far_displacement;
uniform vec2 columns;
uniform vec2 texel;
const ivec2 A=ivec2(16,8);
uniform sampler2D depth_map;
float C(vec4 a){return a.r;}
float D(vec2 a){return C(textureLod(depth_map,(a),0.0));}
vec4 U(vec2 a){ivec2 b=textureSize(depth_map,0).xy-1;ivec2 c=ivec2(floor(a*vec2(b+1)-0.5));ivec2 d=clamp(c,ivec2(0),b);ivec2 e=clamp(c+1,ivec2(0),b);return vec4(C(texelFetch(depth_map,(ivec2(d.x,e.y)),0)),C(texelFetch(depth_map,(e),0)),C(texelFetch(depth_map,(ivec2(e.x,d.y)),0)),C(texelFetch(depth_map,(d),0)));}
float V(float a){return law.x+law.y*a;}
vec2 K(vec2 a){a=a;return vec2(columns.x*a.x+columns.y,(a.y)*texel.y);}
vec4 Ah(vec2 a){vec2 b=vec2(source_size-2);vec2 c=a;float d=c.y+1.0;d=d/float(source_size.y);vec4 e=U(vec2(columns.x*(c.x+1.0)+columns.y,d));return e;}
uint Al(float a,float b){float c=clamp(floor((a-far_displacement)*16.0),0.0,65534.0);float d=clamp(ceil((b-far_displacement)*16.0),0.0,65535.0);return uint(c)|(uint(d)<<16);}
uint Aq(uint a){a=a>>16|a<<16;a=(a&0xff00ff00u)>>8|(a&0x00ff00ffu)<<8;a=(a&0xf0f0f0f0u)>>4|(a&0x0f0f0f0fu)<<4;a=(a&0xccccccccu)>>2|(a&0x33333333u)<<2;return(a&0xaaaaaaaau)>>1|(a&0x55555555u)<<1;}
uint Ab(uint a){return mirrored?a>>16|a<<16:Aq(a);}
uvec4 Ao(vec2 a){const vec2 b=vec2(A.x,A.y-1);vec2 c=a+0.5;float d=D(K(c));float e=D(K(c+vec2(b.x,0.0)));float f=D(K(c+vec2(0.0,b.y)));float g=D(K(c+b));vec2 h=(vec2(e,f)-d)/b;h=abs(law.y*(d-e-f+g))<=4.0*(1.0/16.0)?h:vec2(0.0);vec4 i=vec4(1e9);vec4 j=vec4(-1e9);float k=0.0;uint l=0u;uint m=0u;float n=0.99/abs(law.y);float o=mirrored?b.x-1.0:0.0;float p=mirrored?-1.0:1.0;for(float q=a.y;q<a.y+float(A.y);q+=2.0){l=q==a.y+4.0?m:l;vec2 r=vec2(0.0);for(int s=0;s<=A.x;s+=2){float t=o+p*float(min(s,A.x-1));vec4 u=Ah(vec2(a.x+t,q));vec4 v=u-(k+h.x*t);i=min(i,v);j=max(j,v);vec2 w=abs(u.xw-r);vec2 z=abs(u.yz-u.xw);r=u.yz;if(s>0&&s<A.x){m=m<<1|uint(max(w.x,w.y)>n);}m=m<<1|uint(max(z.x,z.y)>n);}k+=2.0*h.y;}vec4 a0=h.x*(mirrored?vec4(1,0,0,1):vec4(0,1,1,0))+h.y*vec4(1,1,0,0);i-=a0;j-=a0;i.xy=min(i.xy,i.zw);j.xy=max(j.xy,j.zw);float b0=min(i.x,i.y);float c0=max(j.x,j.y);vec2 d0=h*b;float e0=V(b0+min(d0.x,0.0)+min(d0.y,0.0));float f0=V(c0+max(d0.x,0.0)+max(d0.y,0.0));vec3 g0=vec3(V(0.5*(b0+c0)),law.y*h);bool h0=abs(law.y)*(c0-b0)<=2.0*(1.0/16.0)&&abs(g0.y-0.25)<0.75;uvec3 i0=h0?floatBitsToUint(g0):uvec3(Ab(l),floatBitsToUint(9.0),Ab(m));return uvec4(Al(min(e0,f0),max(e0,f0)),i0);}
layout(location=0)out uvec4 tile;
void main(){tile=Ao((gl_FragCoord.xy-0.5)*vec2(A));}`;
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
const ivec2 A=ivec2(16,8);
uint Am(float a,float b){return((floatBitsToUint(a)+0x3ffu)&~0x3ffu)|min(uint(b),0x3ffu);}
uniform highp usampler2D tile_map;
vec3 Ae(int a,int b){vec3 c=uintBitsToFloat(texelFetch(tile_map,ivec2(a,b),0).yzw);float d=float(a*A.x)+c.x;return vec3(d,d+float(A.y-1)*c.z,c.y);}
bool Ap(int a){int b=(source_size.y+A.y-1)/A.y;return(a==0&&row_offset>0)||(a==b-1&&target_size.y-row_offset>source_size.y);}
vec3 Aw(ivec2 a,int b,int c){if(b>c||c>=b+4||Ap(a.y)){return vec3(0.0);}float d=float(a.x*A.x);float e=d+float(A.x-1);vec4 f=vec2(d,e).xyxy;vec4 g=vec4(0.0);bool h=true;for(int i=b;i<=c;++i){vec3 j=Ae(i,a.y);h=h&&j.z<9.0;vec4 k=float(i*A.x)+(f-j.xxyy)/(1.0+j.z);g=mix(g,k,i==b?bvec4(true):lessThanEqual(j.xxyy,f));}vec2 l=vec2(g.y-g.x,g.z-g.x)/vec2(A.x-1,A.y-1);float m=abs(g.w-g.y-g.z+g.x);for(int n=b+1;n<=c;++n){vec2 j=Ae(n,a.y).xy;vec2 o=abs(g.xz+l.x*(j-d)-float(n*A.x));bvec2 p=lessThan(abs(j-0.5*(d+e)),vec2(0.5*(e-d)));m=max(m,max(p.x?o.x:0.0,p.y?o.y:0.0));}vec4 q=vec4(0.5*float(source_size.x-1));if(!h||!(m<=(1.0/16.0))||any(greaterThan(abs(g-q),q))){return vec3(0.0);}float r=g.x+l.x*(origins.y+law.x-d)-l.y*(first_row+0.5+float(a.y*A.y));return vec3(columns.x*(r+0.5)+columns.y,columns.x*l*vec2(origins.x,1.0));}
layout(location=0)out uvec4 span;
void main(){ivec2 a=ivec2(gl_FragCoord.xy);float b=float(a.x*A.x);float c=b+float(A.x-1);int d=(source_size.x+A.x-1)/A.x;int e=clamp(int(floor((b-near_displacement-1.0)/float(A.x)))-1,0,d-1);int f=clamp(int(floor((c-far_displacement+1.0)/float(A.x))),0,d-1);const int g=A.x*int(16.0);int h=int(floor((b-1.0-far_displacement-float((e+1)*A.x))*16.0));int i=int(ceil((c+1.0-far_displacement-float(e*A.x))*16.0));int j=0xffff;int k=0;int l=d;int m=0;for(int n=e;n<=f;++n){uint o=texelFetch(tile_map,ivec2(n,a.y),0).r;int p=max(int(o&0xffffu),h);int q=min(int(o>>16),i);if(p<=q){j=min(j,p);k=max(k,q);l=min(l,n);m=n;}h-=g;i-=g;}if(k<j){j=k=2*a.x*A.x<target_size.x?0xffff:0;}uint s=Am(float(k)/16.0,ceil(float(k-j)/16.0)+2.0);span=uvec4(s,0u,0u,0u);vec3 t=Aw(a,l,m);if(t.y!=0.0){span.xyz=floatBitsToUint(t);}}`;
export const march = /* glsl */`${precisions}
uniform ivec2 source_size;
uniform vec2 law;
uniform bool mirrored;
uniform vec2 columns;
uniform vec2 origins;
uniform vec2 rows;
uniform float first_row;
uniform float farthest;
uniform vec2 texel;
const ivec2 A=ivec2(16,8);
uniform sampler2D depth_map;
uniform sampler2D color_map;
float C(vec4 a){return a.r;}
float D(vec2 a){return C(textureLod(depth_map,(a),0.0));}
vec4 M(vec2 a){return textureLod(color_map,(a),0.0);}
vec4 U(vec2 a){ivec2 b=textureSize(depth_map,0).xy-1;ivec2 c=ivec2(floor(a*vec2(b+1)-0.5));ivec2 d=clamp(c,ivec2(0),b);ivec2 e=clamp(c+1,ivec2(0),b);return vec4(C(texelFetch(depth_map,(ivec2(d.x,e.y)),0)),C(texelFetch(depth_map,(e),0)),C(texelFetch(depth_map,(ivec2(e.x,d.y)),0)),C(texelFetch(depth_map,(d),0)));}
vec2 K(vec2 a){a=a;return vec2(columns.x*a.x+columns.y,(a.y)*texel.y);}
float I(float a){return K(vec2(a+0.5,0.5)).x;}
float F(float a){return rows.x*(gl_FragCoord.y+a)+rows.y;}
float Av(uint a){uint b=a&0x3ffu;return b==0x3ffu?1e9:float(b);}
uniform highp usampler2D span_map;
in vec2 span_at;
uvec4 An(){return texture(span_map,span_at);}
float Aj(uint a){float b=float(a&(~a+1u));return float(floatBitsToUint(b)>>23)-127.0;}
uniform highp usampler2D tile_map;
struct J{float H;float G;bool Q;};
struct T{float x;float G;};
vec4 Ag(T a,float b,out float c){vec2 d=vec2(I(a.x),F(b));c=law.y*(D(d)-a.G);return M(d);}
vec4 Ai(T a,vec4 b,float c){float d=0.5*clamp(abs(c),1.0,12.0);vec4 e=2.0*b;float f=2.0;for(int g=1;g<=2;++g){float h=roundEven(float(g)*d);vec2 i;vec4 j=Ag(a,-h,i.x);vec4 k=Ag(a,h,i.y);vec2 l=vec2(lessThanEqual(i,vec2(1.0)));e+=l.x*j+l.y*k;f+=l.x+l.y;}return e/f;}
struct L{float x;vec2 B;float a;float b;};
vec2 Aa(float a){vec4 b=U(vec2(columns.x*(a+1.25)+columns.y,F(0.25)));return mirrored?b.zw:b.wz;}
L W(float a,float b){vec2 c=Aa(a);float d=a-b;return L(a,c,d+law.y*c.x,d+1.0+law.y*c.y);}
bool Ac(float a,float b){return a<=0.0&&(b>0.0||max(b,-1.0)<a);}
float At(float a,int b,bool c,uint d){uint e=uint(a);uint f=e%uint(A.x);uvec4 g=texelFetch(tile_map,ivec2(e/uint(A.x),b),0);uint h=(c?g.y:g.w)>>(d+f);h=g.z==floatBitsToUint(9.0)?h:0u;return a+Aj(h|0x10000u>>f);}
bool Ad(float a,vec2 b,bool c){float d=D(vec2(I(a-1.0),F(0.0)));float e=D(vec2(I(a+2.0),F(0.0)));float f=2.0-1.0;return law.y*(b.x-d)>=f||(c&&law.y*(b.y-e)>f);}
struct Z{float N;float O;float E;float P;};
bool Af(inout Z c,L d){bool e=d.b>0.0;bool f=d.b-d.a>=2.0;bool g=c.E<0.0&&(!e||(f&&d.b<1.0));c.E=g?d.x+(e?1.0:0.0):c.E;c.P=g?(e?d.B.y:d.B.x):c.P;bool h=e&&law.y*(d.B.x-c.O)<0.0;c.N=h?d.x:c.N;c.O=h?d.B.x:c.O;return e&&(d.a>-0.5||!f);}
vec4 Ak(L a,float b,float c,int d,out J e){float f=a.a-a.x;bool g=a.x<=0.0&&f>0.0;b=g&&f<0.5?0.0:b;Z h;h.N=g?0.0:-1.0;h.O=g?a.B.x:law.y<0.0?-1e9:1e9;h.E=-1.0;h.P=0.0;bool i=false;if(a.x>=0.0&&a.x<b&&Ac(a.a,a.b)){i=Af(h,a);}float j=max(a.x+1.0,0.0);float k=a.b+(j-a.x-1.0);int l=d/A.y;bool m=(d&4)==0;uint n=uint(d&2)<<3;bool o=false;while(j<=b&&!i){a=W(min(At(j,l,m,n),b),c);o=k<=0.0&&a.a>0.0;i=o;if(!o&&a.x<b&&Ac(a.a,a.b)){i=Af(h,a);}j=i?j:a.x+1.0;k=i?k:a.b;}float p=a.x;float q=a.a;while(o&&j<p){a=W(clamp(floor(j+(p-j)*k/(k-q)),j,p-1.0),c);o=a.a>0.0||a.b<=0.0;bool r=a.a>0.0;j=r?j:a.x+1.0;k=r?k:a.b;p=r?a.x:p;q=r?a.a:q;}bool s=i||h.N<0.0;j=s?min(a.x,b):h.N;float t=i&&a.b-a.a<2.0?-a.a/(a.b-a.a):0.0;e.H=j+t;e.G=s?mix(a.B.x,a.B.y,t):h.O;float u=j-c+law.y*e.G;e.Q=!i&&abs(u)>=0.5;bool v=a.b-a.a<2.0;if(e.Q||h.E>=0.0||(i&&Ad(a.x,a.B,v))){discard;}vec4 w=M(vec2(I(e.H),F(0.0)));if(e.Q){w=Ai(T(j,e.G),w,u);}if(h.E>=0.0){float x=1.0-abs(h.E-c+law.y*h.P);w=mix(w,M(vec2(I(h.E),F(0.0))),x);if(x>=0.5){e=J(h.E,h.P,false);}}return w;}
layout(location=0)out vec4 color;
int Au(){return int(clamp(gl_FragCoord.y-first_row,0.0,float(source_size.y-1)));}
vec4 Ar(vec3 a,out J b){float c=a.x+a.y*gl_FragCoord.x+a.z*gl_FragCoord.y;b.H=clamp((c-columns.y)/columns.x-0.5,0.0,float(source_size.x-1));b.G=(origins.x*gl_FragCoord.x+origins.y-b.H)/law.y;if(law.y==0.0){vec2 d=Aa(floor(b.H));b.G=mix(d.x,d.y,fract(b.H));}b.Q=false;vec2 e=vec2(c,F(0.0));return M(e);}
vec4 As(uint c,out J d){float e=origins.x*gl_FragCoord.x+origins.y;L f=W(floor(e-farthest-uintBitsToFloat(c)),e);float g=min(max(f.x,0.0)+Av(c),float(source_size.x-1));float h=min(f.x+2.0,g);for(;f.x<h&&f.b<=0.0&&max(f.b,-1.0)>=f.a;f.x+=1.0){float i=D(vec2(I(f.x+2.0),F(0.0)));f.B=vec2(f.B.y,i);f.a=f.b;f.b=f.x+2.0-e+law.y*i;}float j=f.b-f.a;float k=-f.a/j;d=J(f.x+k,mix(f.B.x,f.B.y,k),false);vec4 l=M(vec2(I(d.H),F(0.0)));float m=0.5*float(source_size.x-1);bool n=f.a<=0.0&&f.b>0.0&&j<2.0&&abs(d.H-m)<=m;if(!n){l=Ak(f,g,e,Au(),d);}else if(Ad(f.x,f.B,true)){discard;}return l;}
void main(){uvec4 a=An();J b;if(a.y!=0u){color=Ar(uintBitsToFloat(a.xyz),b);}else{color=As(a.x,b);}gl_FragDepth=b.G;}`;

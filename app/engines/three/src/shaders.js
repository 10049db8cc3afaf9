// yoro 0.1.0, synthesis passes, written from its GLSL by `cargo xtask maintain renew`. Do not edit.
// SPDX-License-Identifier: MIT OR Apache-2.0
export const precisions = 'precision highp float;precision highp int;precision highp sampler2D;precision highp usampler2D;';
export const screenVertex = /* glsl */`${precisions}
void main(){int id=gl_VertexID;vec2 K=vec2(float((id<<1)&2),float(id&2));gl_Position=vec4(K*2.0-1.0,0.0,1.0);}`;
export const marchVertex = /* glsl */`${precisions}
uniform ivec2 target_size;
uniform ivec2 target_origin;
uniform vec4 span_place;
out vec2 span_at;
void main(){int id=gl_VertexID;vec2 K=vec2(float((id<<1)&2),float(id&2));vec2 J=vec2(target_origin)+K*vec2(target_size);span_at=span_place.xy*J+span_place.zw;gl_Position=vec4(K*2.0-1.0,0.0,1.0);}`;
export const guessedDepth = /* glsl */`${precisions}
uniform ivec2 source_size;
uniform vec2 law;
uniform sampler2D depth_map;
uniform sampler2D color_map;
const float Dm=0.5;
const float Dn=0.15;
const ivec2 Cb[4]=ivec2[4](ivec2(-1,0),ivec2(1,0),ivec2(0,-1),ivec2(0,1));
ivec2 F(ivec2 J){ivec2 I=ivec2(0);return clamp(J,I,I+source_size-1);}
float Bj(ivec2 J){return law.y*texelFetch(depth_map,(F(J)),0).r;}
vec3 By(ivec2 J){return texelFetch(color_map,(F(J)),0).rgb;}
void main(){ivec2 J=ivec2(gl_FragCoord.xy);float Ab=Bj(J)+Dm;float Bv=Ab;ivec2 to=ivec2(0);for(int i=0;i<4;++i){float B=Bj(J+Cb[i]);to=B>Bv?Cb[i]:to;Bv=max(Bv,B);}gl_FragDepth=texelFetch(depth_map,(F(J)),0).r;if(to!=ivec2(0)){vec3 Du=By(J+(Bj(J+2*to)>Ab?2:1)*to);vec3 Cn=By(J);vec3 Ce=Bj(J-to)>Ab?Cn:By(J-to);vec3 Bo=Du-Ce;if(dot(Cn-Ce,Bo)>Dn*max(dot(Bo,Bo),1e-4)){gl_FragDepth=texelFetch(depth_map,(F(J+to)),0).r;}}}`;
export const tiles = /* glsl */`${precisions}
uniform ivec2 source_size;
uniform vec2 law;
uniform bool mirrored;
uniform float far_displacement;
uniform vec2 columns;
uniform ivec2 source_origin;
uniform vec2 texel;
const ivec2 A=ivec2(16,8);
uniform sampler2D depth_map;
float S(vec4 texel){return texel.r;}
float Ae(vec2 F){return S(textureLod(depth_map,(F),0.0));}
vec4 Bp(vec2 F){ivec2 H=textureSize(depth_map,0).xy-1;ivec2 K=ivec2(floor(F*vec2(H+1)-0.5));ivec2 E=clamp(K,ivec2(0),H);ivec2 C=clamp(K+1,ivec2(0),H);return vec4(S(texelFetch(depth_map,(ivec2(E.x,C.y)),0)),S(texelFetch(depth_map,(C),0)),S(texelFetch(depth_map,(ivec2(C.x,E.y)),0)),S(texelFetch(depth_map,(E),0)));}
float Bq(float P){return law.x+law.y*P;}
vec2 Ap(vec2 at){at=at;return vec2(columns.x*at.x+columns.y,(float(source_origin.y)+at.y)*texel.y);}
const float Aa=16.0;
vec4 Dr(vec2 K){vec2 H=vec2(source_size-2);vec2 at=K;float M=at.y+1.0;M=M/float(source_size.y);vec4 W=Bp(vec2(columns.x*(at.x+1.0)+columns.y,M));return W;}
uint Dz(float E,float C){float Bi=clamp(floor((E-far_displacement)*Aa),0.0,65534.0);float Bh=clamp(ceil((C-far_displacement)*Aa),0.0,65535.0);return uint(Bi)|(uint(Bh)<<16);}
uint Eh(uint L){L=L>>16|L<<16;L=(L&0xff00ff00u)>>8|(L&0x00ff00ffu)<<8;L=(L&0xf0f0f0f0u)>>4|(L&0x0f0f0f0fu)<<4;L=(L&0xccccccccu)>>2|(L&0x33333333u)<<2;return(L&0xaaaaaaaau)>>1|(L&0x55555555u)<<1;}
const float Be=1.0/16.0;
const float As=9.0;
const float Dl=0.99;
uint Co(uint N){return mirrored?N>>16|N<<16:Eh(N);}
uvec4 Ec(vec2 K){const vec2 Ah=vec2(A.x,A.y-1);vec2 V=K+0.5;float I=Ae(Ap(V));float X=Ae(Ap(V+vec2(Ah.x,0.0)));float Bf=Ae(Ap(V+vec2(0.0,Ah.y)));float Dy=Ae(Ap(V+Ah));vec2 Q=(vec2(X,Bf)-I)/Ah;Q=abs(law.y*(I-X-Bf+Dy))<=4.0*Be?Q:vec2(0.0);vec4 E=vec4(1e9);vec4 C=vec4(-1e9);float Aq=0.0;uint Bu=0u;uint N=0u;float Cs=Dl/abs(law.y);float Do=mirrored?Ah.x-1.0:0.0;float Em=mirrored?-1.0:1.0;for(float M=K.y;M<K.y+float(A.y);M+=2.0){Bu=M==K.y+4.0?N:Bu;vec2 Cf=vec2(0.0);for(int i=0;i<=A.x;i+=2){float Ad=Do+Em*float(min(i,A.x-1));vec4 W=Dr(vec2(K.x+Ad,M));vec4 G=W-(Aq+Q.x*Ad);E=min(E,G);C=max(C,G);vec2 Cg=abs(W.xw-Cf);vec2 Bd=abs(W.yz-W.xw);Cf=W.yz;if(i>0&&i<A.x){N=N<<1|uint(max(Cg.x,Cg.y)>Cs);}N=N<<1|uint(max(Bd.x,Bd.y)>Cs);}Aq+=2.0*Q.y;}vec4 Cz=Q.x*(mirrored?vec4(1,0,0,1):vec4(0,1,1,0))+Q.y*vec4(1,1,0,0);E-=Cz;C-=Cz;E.xy=min(E.xy,E.zw);C.xy=max(C.xy,C.zw);float An=min(E.x,E.y);float Ao=max(C.x,C.y);vec2 Bk=Q*Ah;float a=Bq(An+min(Bk.x,0.0)+min(Bk.y,0.0));float b=Bq(Ao+max(Bk.x,0.0)+max(Bk.y,0.0));vec3 Cy=vec3(Bq(0.5*(An+Ao)),law.y*Q);bool Bb=abs(law.y)*(Ao-An)<=2.0*Be&&abs(Cy.y-0.25)<0.75;uvec3 Eg=Bb?floatBitsToUint(Cy):uvec3(Co(Bu),floatBitsToUint(As),Co(N));return uvec4(Dz(min(a,b),max(a,b)),Eg);}
layout(location=0)out uvec4 tile;
void main(){tile=Ec((gl_FragCoord.xy-0.5)*vec2(A));}`;
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
const float Aa=16.0;
const uint Aj=0x3ffu;
uint Ea(float Ee,float columns){return((floatBitsToUint(Ee)+Aj)&~Aj)|min(uint(columns),Aj);}
uniform highp usampler2D tile_map;
const float Be=1.0/16.0;
const float As=9.0;
const int Dk=4;
vec3 Cr(int Db,int M){vec3 Aq=uintBitsToFloat(texelFetch(tile_map,ivec2(Db,M),0).yzw);float I=float(Db*A.x)+Aq.x;return vec3(I,I+float(A.y-1)*Aq.z,Aq.y);}
bool Ef(int M){int rows=(source_size.y+A.y-1)/A.y;return(M==0&&row_offset>0)||(M==rows-1&&target_size.y-row_offset>source_size.y);}
vec3 Eq(ivec2 tile,int Z,int X){if(Z>X||X>=Z+Dk||Ef(tile.y)){return vec3(0.0);}float I=float(tile.x*A.x);float H=I+float(A.x-1);vec4 Cl=vec2(I,H).xyxy;vec4 O=vec4(0.0);bool Bb=true;for(int s=Z;s<=X;++s){vec3 Af=Cr(s,tile.y);Bb=Bb&&Af.z<As;vec4 F=float(s*A.x)+(Cl-Af.xxyy)/(1.0+Af.z);O=mix(O,F,s==Z?bvec4(true):lessThanEqual(Af.xxyy,Cl));}vec2 Q=vec2(O.y-O.x,O.z-O.x)/vec2(A.x-1,A.y-1);float Br=abs(O.w-O.y-O.z+O.x);for(int s=Z+1;s<=X;++s){vec2 Af=Cr(s,tile.y).xy;vec2 Cw=abs(O.xz+Q.x*(Af-I)-float(s*A.x));bvec2 Cp=lessThan(abs(Af-0.5*(I+H)),vec2(0.5*(H-I)));Br=max(Br,max(Cp.x?Cw.x:0.0,Cp.y?Cw.y:0.0));}vec4 V=vec4(0.5*float(source_size.x-1));if(!Bb||!(Br<=Be)||any(greaterThan(abs(O-V),V))){return vec3(0.0);}float Ad=O.x+Q.x*(origins.y+law.x-I)-Q.y*(first_row+0.5+float(tile.y*A.y));return vec3(columns.x*(Ad+0.5)+columns.y,columns.x*Q*vec2(origins.x,1.0));}
layout(location=0)out uvec4 span;
void main(){ivec2 tile=ivec2(gl_FragCoord.xy);float I=float(tile.x*A.x);float H=I+float(A.x-1);int Ca=(source_size.x+A.x-1)/A.x;int Bs=clamp(int(floor((I-near_displacement-1.0)/float(A.x)))-1,0,Ca-1);int to=clamp(int(floor((H-far_displacement+1.0)/float(A.x))),0,Ca-1);const int Cd=A.x*int(Aa);int An=int(floor((I-1.0-far_displacement-float((Bs+1)*A.x))*Aa));int Ao=int(ceil((H+1.0-far_displacement-float(Bs*A.x))*Aa));int E=0xffff;int C=0;int Z=Ca;int X=0;for(int s=Bs;s<=to;++s){uint Cu=texelFetch(tile_map,ivec2(s,tile.y),0).r;int Bi=max(int(Cu&0xffffu),An);int Bh=min(int(Cu>>16),Ao);if(Bi<=Bh){E=min(E,Bi);C=max(C,Bh);Z=min(Z,s);X=s;}An-=Cd;Ao-=Cd;}if(C<E){E=C=2*tile.x*A.x<target_size.x?0xffff:0;}uint Ej=Ea(float(C)/Aa,ceil(float(C-E)/Aa)+2.0);span=uvec4(Ej,0u,0u,0u);vec3 Al=Eq(tile,Z,X);if(Al.y!=0.0){span.xyz=floatBitsToUint(Al);}}`;
export const march = /* glsl */`${precisions}
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
const float Bn=2.0;
const ivec2 A=ivec2(16,8);
uniform sampler2D depth_map;
uniform sampler2D color_map;
float S(vec4 texel){return texel.r;}
float Ae(vec2 F){return S(textureLod(depth_map,(F),0.0));}
vec4 Av(vec2 F){return textureLod(color_map,(F),0.0);}
vec4 Bp(vec2 F){ivec2 H=textureSize(depth_map,0).xy-1;ivec2 K=ivec2(floor(F*vec2(H+1)-0.5));ivec2 E=clamp(K,ivec2(0),H);ivec2 C=clamp(K+1,ivec2(0),H);return vec4(S(texelFetch(depth_map,(ivec2(E.x,C.y)),0)),S(texelFetch(depth_map,(C),0)),S(texelFetch(depth_map,(ivec2(C.x,E.y)),0)),S(texelFetch(depth_map,(E),0)));}
vec2 Ap(vec2 at){at=at;return vec2(columns.x*at.x+columns.y,(float(source_origin.y)+at.y)*texel.y);}
float Aw(float x){return Ap(vec2(x+0.5,0.5)).x;}
float Ag(float Am){return rows.x*(gl_FragCoord.y+Am)+rows.y;}
const uint Aj=0x3ffu;
float Eo(uint span){uint Dc=span&Aj;return Dc==Aj?1e9:float(Dc);}
uniform highp usampler2D span_map;
in vec2 span_at;
uvec4 Eb(){return texture(span_map,span_at);}
float Dw(uint L){float Ed=float(L&(~L+1u));return float(floatBitsToUint(Ed)>>23)-127.0;}
const float As=9.0;
uniform highp usampler2D tile_map;
struct Ak{float Ac;float P;bool Bt;};
struct Bm{float x;float P;};
vec4 Df(Bm R,float Bg,out float Ba){vec2 F=vec2(Aw(R.x),Ag(Bg));Ba=law.y*(Ae(F)-R.P);return Av(F);}
vec4 Dt(Bm R,vec4 color,float Am){float Ep=0.5*clamp(abs(Am),1.0,12.0);vec4 De=2.0*color;float Dh=2.0;for(int i=1;i<=2;++i){float Bg=roundEven(float(i)*Ep);vec2 Ba;vec4 Au=Df(R,-Bg,Ba.x);vec4 Bf=Df(R,Bg,Ba.y);vec2 Bl=vec2(lessThanEqual(Ba,vec2(1.0)));De+=Bl.x*Au+Bl.y*Bf;Dh+=Bl.x+Bl.y;}return De/Dh;}
struct At{float x;vec2 G;float a;float b;};
vec2 Ck(float x){vec4 W=Bp(vec2(columns.x*(x+1.25)+columns.y,Ag(0.25)));return mirrored?W.zw:W.wz;}
At Bx(float x,float origin){vec2 G=Ck(x);float Ar=x-origin;return At(x,G,Ar+law.y*G.x,Ar+1.0+law.y*G.y);}
bool Cq(float a,float b){return a<=0.0&&(b>0.0||max(b,-1.0)<a);}
float El(float x,int Bz,bool Au,uint Ar){uint Ad=uint(x);uint Bd=Ad%uint(A.x);uvec4 tile=texelFetch(tile_map,ivec2(Ad/uint(A.x),Bz),0);uint N=(Au?tile.y:tile.w)>>(Ar+Bd);N=tile.z==floatBitsToUint(As)?N:0u;return x+Dw(N|0x10000u>>Bd);}
struct Cc{float R;float Ay;float T;float Bc;};
bool Ct(inout Cc B,At at){bool Az=at.b>0.0;bool Dg=at.b-at.a>=Bn;bool T=B.T<0.0&&(!Az||(Dg&&at.b<1.0));B.T=T?at.x+(Az?1.0:0.0):B.T;B.Bc=T?(Az?at.G.y:at.G.x):B.Bc;bool Cm=Az&&law.y*(at.G.x-B.Ay)<0.0;B.R=Cm?at.x:B.R;B.Ay=Cm?at.G.x:B.Ay;return Az&&(at.a>-0.5||!Dg);}
vec4 Dx(At at,float U,float origin,int M,out Ak D){float Ch=at.a-at.x;bool Bw=at.x<=0.0&&Ch>0.0;U=Bw&&Ch<0.5?0.0:U;Cc B;B.R=Bw?0.0:-1.0;B.Ay=Bw?at.G.x:law.y<0.0?-1e9:1e9;B.T=-1.0;B.Bc=0.0;bool Y=false;if(at.x>=0.0&&at.x<U&&Cq(at.a,at.b)){Y=Ct(B,at);}float x=max(at.x+1.0,0.0);float a=at.b+(x-at.x-1.0);int Bz=M/A.y;bool Au=(M&4)==0;uint Ar=uint(M&2)<<3;bool Ax=false;while(x<=U&&!Y){at=Bx(min(El(x,Bz,Au,Ar),U),origin);Ax=a<=0.0&&at.a>0.0;Y=Ax;if(!Ax&&at.x<U&&Cq(at.a,at.b)){Y=Ct(B,at);}x=Y?x:at.x+1.0;a=Y?a:at.b;}float H=at.x;float b=at.a;while(Ax&&x<H){at=Bx(clamp(floor(x+(H-x)*a/(a-b)),x,H-1.0),origin);Ax=at.a>0.0||at.b<=0.0;bool Ab=at.a>0.0;x=Ab?x:at.x+1.0;a=Ab?a:at.b;H=Ab?at.x:H;b=Ab?at.a:b;}bool Cx=Y||B.R<0.0;x=Cx?min(at.x,U):B.R;float t=Y&&at.b-at.a<Bn?-at.a/(at.b-at.a):0.0;D.Ac=x+t;D.P=Cx?mix(at.G.x,at.G.y,t):B.Ay;float Am=x-origin+law.y*D.P;D.Bt=!Y&&abs(Am)>=0.5;vec4 color=Av(vec2(Aw(D.Ac),Ag(0.0)));if(D.Bt){color=Dt(Bm(x,D.P),color,Am);}if(B.T>=0.0){float Cj=1.0-abs(B.T-origin+law.y*B.Bc);color=mix(color,Av(vec2(Aw(B.T),Ag(0.0))),Cj);if(Cj>=0.5){D=Ak(B.T,B.Bc,false);}}return color;}
layout(location=0)out vec4 color;
int En(){return int(clamp(gl_FragCoord.y-first_row,0.0,float(source_size.y-1)));}
const float Di=2.0;
vec4 Ei(vec3 Al,out Ak D){float F=Al.x+Al.y*gl_FragCoord.x+Al.z*gl_FragCoord.y;D.Ac=clamp((F-columns.y)/columns.x-0.5,0.0,float(source_size.x-1));D.P=(origins.x*gl_FragCoord.x+origins.y-D.Ac)/law.y;if(law.y==0.0){vec2 G=Ck(floor(D.Ac));D.P=mix(G.x,G.y,fract(D.Ac));}D.Bt=false;vec2 at=vec2(F,Ag(0.0));return Av(at);}
vec4 Ek(uint span,out Ak D){float origin=origins.x*gl_FragCoord.x+origins.y;At at=Bx(floor(origin-farthest-uintBitsToFloat(span)),origin);float U=min(max(at.x,0.0)+Eo(span),float(source_size.x-1));float Dv=min(at.x+Di,U);for(;at.x<Dv&&at.b<=0.0&&max(at.b,-1.0)>=at.a;at.x+=1.0){float Cv=Ae(vec2(Aw(at.x+2.0),Ag(0.0)));at.G=vec2(at.G.y,Cv);at.a=at.b;at.b=at.x+2.0-origin+law.y*Cv;}float Dd=at.b-at.a;float t=-at.a/Dd;D=Ak(at.x+t,mix(at.G.x,at.G.y,t),false);vec4 Da=Av(vec2(Aw(D.Ac),Ag(0.0)));float V=0.5*float(source_size.x-1);bool Ds=at.a<=0.0&&at.b>0.0&&Dd<Bn&&abs(D.Ac-V)<=V;if(!Ds){Da=Dx(at,U,origin,En(),D);}return Da;}
void main(){uvec4 span=Eb();Ak D;if(span.y!=0u){color=Ei(uintBitsToFloat(span.xyz),D);}else{color=Ek(span.x,D);}gl_FragDepth=D.P;}`;
export const nearFraction = /* glsl */`${precisions}
uniform highp sampler2D depth_map;
float Dq(ivec2 p){return texelFetch(depth_map,p,0).x;}
uniform ivec2 origin;
uniform ivec2 size;
uniform float near_depth;
uniform bool reversed;
layout(location=0)out vec4 fraction;
const int Dj=16;
const int Ai=8;
void main(){ivec2 Dp=ivec2(gl_FragCoord.xy)*Ai;float Ci=0.0;for(int j=0;j<Ai;++j){for(int i=0;i<Ai;++i){ivec2 J=origin+((Dp+ivec2(i,j))*2+1)*size/(2*Dj*Ai);float P=Dq(J);Ci+=(reversed?P>near_depth:P<near_depth)?1.0:0.0;}}fraction=vec4(Ci/float(Ai*Ai));}`;

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
void main(){int id=gl_VertexID;vec2 K=vec2(float((id<<1)&2),float(id&2));vec2 I=vec2(target_origin)+K*vec2(target_size);span_at=span_place.xy*I+span_place.zw;gl_Position=vec4(K*2.0-1.0,0.0,1.0);}`;
export const guessedDepth = /* glsl */`${precisions}
uniform ivec2 source_size;
uniform vec2 law;
uniform sampler2D depth_map;
uniform sampler2D color_map;
const float Dm=0.5;
const float Dn=0.15;
const ivec2 Cd[4]=ivec2[4](ivec2(-1,0),ivec2(1,0),ivec2(0,-1),ivec2(0,1));
ivec2 G(ivec2 I){ivec2 J=ivec2(0);return clamp(I,J,J+source_size-1);}
float Bm(ivec2 I){return law.y*texelFetch(depth_map,(G(I)),0).r;}
vec3 Bz(ivec2 I){return texelFetch(color_map,(G(I)),0).rgb;}
void main(){ivec2 I=ivec2(gl_FragCoord.xy);float Ae=Bm(I)+Dm;float Bw=Ae;ivec2 to=ivec2(0);for(int i=0;i<4;++i){float B=Bm(I+Cd[i]);to=B>Bw?Cd[i]:to;Bw=max(Bw,B);}gl_FragDepth=texelFetch(depth_map,(G(I)),0).r;if(to!=ivec2(0)){vec3 Dt=Bz(I+(Bm(I+2*to)>Ae?2:1)*to);vec3 Cn=Bz(I);vec3 Cg=Bm(I-to)>Ae?Cn:Bz(I-to);vec3 Bq=Dt-Cg;if(dot(Cn-Cg,Bq)>Dn*max(dot(Bq,Bq),1e-4)){gl_FragDepth=texelFetch(depth_map,(G(I+to)),0).r;}}}`;
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
float Aa(vec2 G){return S(textureLod(depth_map,(G),0.0));}
vec4 Br(vec2 G){ivec2 H=textureSize(depth_map,0).xy-1;ivec2 K=ivec2(floor(G*vec2(H+1)-0.5));ivec2 F=clamp(K,ivec2(0),H);ivec2 E=clamp(K+1,ivec2(0),H);return vec4(S(texelFetch(depth_map,(ivec2(F.x,E.y)),0)),S(texelFetch(depth_map,(E),0)),S(texelFetch(depth_map,(ivec2(E.x,F.y)),0)),S(texelFetch(depth_map,(F),0)));}
float Bs(float U){return law.x+law.y*U;}
vec2 Aq(vec2 at){at=at;return vec2(columns.x*at.x+columns.y,(float(source_origin.y)+at.y)*texel.y);}
const float Ad=16.0;
vec4 Dq(vec2 K){vec2 H=vec2(source_size-2);vec2 at=K;float M=at.y+1.0;M=M/float(source_size.y);vec4 Y=Br(vec2(columns.x*(at.x+1.0)+columns.y,M));return Y;}
uint Dy(float F,float E){float Bl=clamp(floor((F-far_displacement)*Ad),0.0,65534.0);float Bj=clamp(ceil((E-far_displacement)*Ad),0.0,65535.0);return uint(Bl)|(uint(Bj)<<16);}
uint Eg(uint L){L=L>>16|L<<16;L=(L&0xff00ff00u)>>8|(L&0x00ff00ffu)<<8;L=(L&0xf0f0f0f0u)>>4|(L&0x0f0f0f0fu)<<4;L=(L&0xccccccccu)>>2|(L&0x33333333u)<<2;return(L&0xaaaaaaaau)>>1|(L&0x55555555u)<<1;}
const float Bf=1.0/16.0;
const float Au=9.0;
const float Dl=0.99;
uint Co(uint N){return mirrored?N>>16|N<<16:Eg(N);}
uvec4 Eb(vec2 K){const vec2 Aj=vec2(A.x,A.y-1);vec2 X=K+0.5;float J=Aa(Aq(X));float Z=Aa(Aq(X+vec2(Aj.x,0.0)));float Bg=Aa(Aq(X+vec2(0.0,Aj.y)));float Dx=Aa(Aq(X+Aj));vec2 P=(vec2(Z,Bg)-J)/Aj;P=abs(law.y*(J-Z-Bg+Dx))<=4.0*Bf?P:vec2(0.0);vec4 F=vec4(1e9);vec4 E=vec4(-1e9);float Ar=0.0;uint Bv=0u;uint N=0u;float Ct=Dl/abs(law.y);float Dp=mirrored?Aj.x-1.0:0.0;float El=mirrored?-1.0:1.0;for(float M=K.y;M<K.y+float(A.y);M+=2.0){Bv=M==K.y+4.0?N:Bv;vec2 Bh=vec2(0.0);for(int i=0;i<=A.x;i+=2){float Ag=Dp+El*float(min(i,A.x-1));vec4 Y=Dq(vec2(K.x+Ag,M));vec4 C=Y-(Ar+P.x*Ag);F=min(F,C);E=max(E,C);vec2 Ch=abs(Y.xw-Bh);vec2 Be=abs(Y.yz-Y.xw);Bh=Y.yz;if(i>0&&i<A.x){N=N<<1|uint(max(Ch.x,Ch.y)>Ct);}N=N<<1|uint(max(Be.x,Be.y)>Ct);}Ar+=2.0*P.y;}vec4 Da=P.x*(mirrored?vec4(1,0,0,1):vec4(0,1,1,0))+P.y*vec4(1,1,0,0);F-=Da;E-=Da;F.xy=min(F.xy,F.zw);E.xy=max(E.xy,E.zw);float Ao=min(F.x,F.y);float Ap=max(E.x,E.y);vec2 Bn=P*Aj;float a=Bs(Ao+min(Bn.x,0.0)+min(Bn.y,0.0));float b=Bs(Ap+max(Bn.x,0.0)+max(Bn.y,0.0));vec3 Cz=vec3(Bs(0.5*(Ao+Ap)),law.y*P);bool Bc=abs(law.y)*(Ap-Ao)<=2.0*Bf&&abs(Cz.y-0.25)<0.75;uvec3 Ef=Bc?floatBitsToUint(Cz):uvec3(Co(Bv),floatBitsToUint(Au),Co(N));return uvec4(Dy(min(a,b),max(a,b)),Ef);}
layout(location=0)out uvec4 tile;
void main(){tile=Eb((gl_FragCoord.xy-0.5)*vec2(A));}`;
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
const float Ad=16.0;
const uint Ak=0x3ffu;
uint Dz(float Ed,float columns){return((floatBitsToUint(Ed)+Ak)&~Ak)|min(uint(columns),Ak);}
uniform highp usampler2D tile_map;
const float Bf=1.0/16.0;
const float Au=9.0;
const int Dk=4;
vec3 Cs(int Dc,int M){vec3 Ar=uintBitsToFloat(texelFetch(tile_map,ivec2(Dc,M),0).yzw);float J=float(Dc*A.x)+Ar.x;return vec3(J,J+float(A.y-1)*Ar.z,Ar.y);}
bool Ee(int M){int rows=(source_size.y+A.y-1)/A.y;return(M==0&&row_offset>0)||(M==rows-1&&target_size.y-row_offset>source_size.y);}
vec3 Ep(ivec2 tile,int Ab,int Z){if(Ab>Z||Z>=Ab+Dk||Ee(tile.y)){return vec3(0.0);}float J=float(tile.x*A.x);float H=J+float(A.x-1);vec4 Cl=vec2(J,H).xyxy;vec4 O=vec4(0.0);bool Bc=true;for(int s=Ab;s<=Z;++s){vec3 Ai=Cs(s,tile.y);Bc=Bc&&Ai.z<Au;vec4 G=float(s*A.x)+(Cl-Ai.xxyy)/(1.0+Ai.z);O=mix(O,G,s==Ab?bvec4(true):lessThanEqual(Ai.xxyy,Cl));}vec2 P=vec2(O.y-O.x,O.z-O.x)/vec2(A.x-1,A.y-1);float Bt=abs(O.w-O.y-O.z+O.x);for(int s=Ab+1;s<=Z;++s){vec2 Ai=Cs(s,tile.y).xy;vec2 Cx=abs(O.xz+P.x*(Ai-J)-float(s*A.x));bvec2 Cp=lessThan(abs(Ai-0.5*(J+H)),vec2(0.5*(H-J)));Bt=max(Bt,max(Cp.x?Cx.x:0.0,Cp.y?Cx.y:0.0));}vec4 X=vec4(0.5*float(source_size.x-1));if(!Bc||!(Bt<=Bf)||any(greaterThan(abs(O-X),X))){return vec3(0.0);}float Ag=O.x+P.x*(origins.y+law.x-J)-P.y*(first_row+0.5+float(tile.y*A.y));return vec3(columns.x*(Ag+0.5)+columns.y,columns.x*P*vec2(origins.x,1.0));}
layout(location=0)out uvec4 span;
void main(){ivec2 tile=ivec2(gl_FragCoord.xy);float J=float(tile.x*A.x);float H=J+float(A.x-1);int Cc=(source_size.x+A.x-1)/A.x;int Bu=clamp(int(floor((J-near_displacement-1.0)/float(A.x)))-1,0,Cc-1);int to=clamp(int(floor((H-far_displacement+1.0)/float(A.x))),0,Cc-1);const int Cf=A.x*int(Ad);int Ao=int(floor((J-1.0-far_displacement-float((Bu+1)*A.x))*Ad));int Ap=int(ceil((H+1.0-far_displacement-float(Bu*A.x))*Ad));int F=0xffff;int E=0;int Ab=Cc;int Z=0;for(int s=Bu;s<=to;++s){uint Cv=texelFetch(tile_map,ivec2(s,tile.y),0).r;int Bl=max(int(Cv&0xffffu),Ao);int Bj=min(int(Cv>>16),Ap);if(Bl<=Bj){F=min(F,Bl);E=max(E,Bj);Ab=min(Ab,s);Z=s;}Ao-=Cf;Ap-=Cf;}if(E<F){F=E=2*tile.x*A.x<target_size.x?0xffff:0;}uint Ei=Dz(float(E)/Ad,ceil(float(E-F)/Ad)+2.0);span=uvec4(Ei,0u,0u,0u);vec3 Am=Ep(tile,Ab,Z);if(Am.y!=0.0){span.xyz=floatBitsToUint(Am);}}`;
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
const float At=2.0;
const ivec2 A=ivec2(16,8);
uniform sampler2D depth_map;
uniform sampler2D color_map;
float S(vec4 texel){return texel.r;}
float Aa(vec2 G){return S(textureLod(depth_map,(G),0.0));}
vec4 Ax(vec2 G){return textureLod(color_map,(G),0.0);}
vec4 Br(vec2 G){ivec2 H=textureSize(depth_map,0).xy-1;ivec2 K=ivec2(floor(G*vec2(H+1)-0.5));ivec2 F=clamp(K,ivec2(0),H);ivec2 E=clamp(K+1,ivec2(0),H);return vec4(S(texelFetch(depth_map,(ivec2(F.x,E.y)),0)),S(texelFetch(depth_map,(E),0)),S(texelFetch(depth_map,(ivec2(E.x,F.y)),0)),S(texelFetch(depth_map,(F),0)));}
vec2 Aq(vec2 at){at=at;return vec2(columns.x*at.x+columns.y,(float(source_origin.y)+at.y)*texel.y);}
float Ah(float x){return Aq(vec2(x+0.5,0.5)).x;}
float Ac(float An){return rows.x*(gl_FragCoord.y+An)+rows.y;}
const uint Ak=0x3ffu;
float En(uint span){uint Dd=span&Ak;return Dd==Ak?1e9:float(Dd);}
uniform highp usampler2D span_map;
in vec2 span_at;
uvec4 Ea(){return texture(span_map,span_at);}
float Dv(uint L){float Ec=float(L&(~L+1u));return float(floatBitsToUint(Ec)>>23)-127.0;}
const float Au=9.0;
uniform highp usampler2D tile_map;
struct Al{float Af;float U;bool Bk;};
struct Bp{float x;float U;};
vec4 Dg(Bp R,float Bi,out float Bb){vec2 G=vec2(Ah(R.x),Ac(Bi));Bb=law.y*(Aa(G)-R.U);return Ax(G);}
vec4 Ds(Bp R,vec4 color,float An){float Eo=0.5*clamp(abs(An),1.0,12.0);vec4 Df=2.0*color;float Di=2.0;for(int i=1;i<=2;++i){float Bi=roundEven(float(i)*Eo);vec2 Bb;vec4 Aw=Dg(R,-Bi,Bb.x);vec4 Bg=Dg(R,Bi,Bb.y);vec2 Bo=vec2(lessThanEqual(Bb,vec2(1.0)));Df+=Bo.x*Aw+Bo.y*Bg;Di+=Bo.x+Bo.y;}return Df/Di;}
struct Av{float x;vec2 C;float a;float b;};
vec2 Ck(float x){vec4 Y=Br(vec2(columns.x*(x+1.25)+columns.y,Ac(0.25)));return mirrored?Y.zw:Y.wz;}
Av By(float x,float T){vec2 C=Ck(x);float As=x-T;return Av(x,C,As+law.y*C.x,As+1.0+law.y*C.y);}
bool Cq(float a,float b){return a<=0.0&&(b>0.0||max(b,-1.0)<a);}
float Ek(float x,int Cb,bool Aw,uint As){uint Ag=uint(x);uint Be=Ag%uint(A.x);uvec4 tile=texelFetch(tile_map,ivec2(Ag/uint(A.x),Cb),0);uint N=(Aw?tile.y:tile.w)>>(As+Be);N=tile.z==floatBitsToUint(Au)?N:0u;return x+Dv(N|0x10000u>>Be);}
bool Cr(float x,vec2 C,bool Ca){float Bh=Aa(vec2(Ah(x-1.0),Ac(0.0)));float Do=Aa(vec2(Ah(x+2.0),Ac(0.0)));float I=At-1.0;return law.y*(C.x-Bh)>=I||(Ca&&law.y*(C.y-Do)>I);}
struct Ce{float R;float Az;float Q;float Bd;};
bool Cu(inout Ce B,Av at){bool Ba=at.b>0.0;bool Dh=at.b-at.a>=At;bool Q=B.Q<0.0&&(!Ba||(Dh&&at.b<1.0));B.Q=Q?at.x+(Ba?1.0:0.0):B.Q;B.Bd=Q?(Ba?at.C.y:at.C.x):B.Bd;bool Cm=Ba&&law.y*(at.C.x-B.Az)<0.0;B.R=Cm?at.x:B.R;B.Az=Cm?at.C.x:B.Az;return Ba&&(at.a>-0.5||!Dh);}
vec4 Dw(Av at,float V,float T,int M,out Al D){float Ci=at.a-at.x;bool Bx=at.x<=0.0&&Ci>0.0;V=Bx&&Ci<0.5?0.0:V;Ce B;B.R=Bx?0.0:-1.0;B.Az=Bx?at.C.x:law.y<0.0?-1e9:1e9;B.Q=-1.0;B.Bd=0.0;bool W=false;if(at.x>=0.0&&at.x<V&&Cq(at.a,at.b)){W=Cu(B,at);}float x=max(at.x+1.0,0.0);float a=at.b+(x-at.x-1.0);int Cb=M/A.y;bool Aw=(M&4)==0;uint As=uint(M&2)<<3;bool Ay=false;while(x<=V&&!W){at=By(min(Ek(x,Cb,Aw,As),V),T);Ay=a<=0.0&&at.a>0.0;W=Ay;if(!Ay&&at.x<V&&Cq(at.a,at.b)){W=Cu(B,at);}x=W?x:at.x+1.0;a=W?a:at.b;}float H=at.x;float b=at.a;while(Ay&&x<H){at=By(clamp(floor(x+(H-x)*a/(a-b)),x,H-1.0),T);Ay=at.a>0.0||at.b<=0.0;bool Ae=at.a>0.0;x=Ae?x:at.x+1.0;a=Ae?a:at.b;H=Ae?at.x:H;b=Ae?at.a:b;}bool Cy=W||B.R<0.0;x=Cy?min(at.x,V):B.R;float t=W&&at.b-at.a<At?-at.a/(at.b-at.a):0.0;D.Af=x+t;D.U=Cy?mix(at.C.x,at.C.y,t):B.Az;float An=x-T+law.y*D.U;D.Bk=!W&&abs(An)>=0.5;bool Ca=at.b-at.a<At;if(D.Bk||B.Q>=0.0||(W&&Cr(at.x,at.C,Ca))){discard;}vec4 color=Ax(vec2(Ah(D.Af),Ac(0.0)));if(D.Bk){color=Ds(Bp(x,D.U),color,An);}if(B.Q>=0.0){float Cj=1.0-abs(B.Q-T+law.y*B.Bd);color=mix(color,Ax(vec2(Ah(B.Q),Ac(0.0))),Cj);if(Cj>=0.5){D=Al(B.Q,B.Bd,false);}}return color;}
layout(location=0)out vec4 color;
int Em(){return int(clamp(gl_FragCoord.y-first_row,0.0,float(source_size.y-1)));}
const float Dj=2.0;
vec4 Eh(vec3 Am,out Al D){float G=Am.x+Am.y*gl_FragCoord.x+Am.z*gl_FragCoord.y;D.Af=clamp((G-columns.y)/columns.x-0.5,0.0,float(source_size.x-1));D.U=(origins.x*gl_FragCoord.x+origins.y-D.Af)/law.y;if(law.y==0.0){vec2 C=Ck(floor(D.Af));D.U=mix(C.x,C.y,fract(D.Af));}D.Bk=false;vec2 at=vec2(G,Ac(0.0));return Ax(at);}
vec4 Ej(uint span,out Al D){float T=origins.x*gl_FragCoord.x+origins.y;Av at=By(floor(T-farthest-uintBitsToFloat(span)),T);float V=min(max(at.x,0.0)+En(span),float(source_size.x-1));float Du=min(at.x+Dj,V);for(;at.x<Du&&at.b<=0.0&&max(at.b,-1.0)>=at.a;at.x+=1.0){float Cw=Aa(vec2(Ah(at.x+2.0),Ac(0.0)));at.C=vec2(at.C.y,Cw);at.a=at.b;at.b=at.x+2.0-T+law.y*Cw;}float De=at.b-at.a;float t=-at.a/De;D=Al(at.x+t,mix(at.C.x,at.C.y,t),false);vec4 Db=Ax(vec2(Ah(D.Af),Ac(0.0)));float X=0.5*float(source_size.x-1);bool Dr=at.a<=0.0&&at.b>0.0&&De<At&&abs(D.Af-X)<=X;if(!Dr){Db=Dw(at,V,T,Em(),D);}else if(Cr(at.x,at.C,true)){discard;}return Db;}
void main(){uvec4 span=Ea();Al D;if(span.y!=0u){color=Eh(uintBitsToFloat(span.xyz),D);}else{color=Ej(span.x,D);}gl_FragDepth=D.U;}`;
